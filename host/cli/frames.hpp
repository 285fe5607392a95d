#pragma once

#include <string>

namespace luciole {

/// The frames that --frames names: both ends belong to them.
struct FrameRange {
  int first = 1;
  int last = 1;
  bool is_range = false;  ///< typed as A-B: each picture has its number in its name, even a single one
};

/// Reads --frames: "A-B" or "A", whole numbers from 0 to 9,999,999; empty: 1. Throws InputError.
FrameRange chosenFrames(const std::string& option);

/// The same for a command that makes one picture.
int chosenFrame(const std::string& option, const std::string& command);

/// The last run of # in a file's name (not in its folder's) as the frame's number, padded with zeros to as
/// many digits. A name without # stays as it is.
std::string frameFile(const std::string& pattern, int frame);

/// Throws InputError where the files of several frames would have the same name: `option` names it.
void checkPattern(const std::string& pattern, const std::string& option);

}  // namespace luciole
