#pragma once

#include <string>
#include <vector>

namespace luciole {

/// The frames that --frames names.
struct FrameChoice {
  std::vector<int> frames{1};  ///< in the order typed, none twice
  bool is_list = false;        ///< typed as more than a number: each picture has its number in its name
};

/// Reads --frames: frames "A", ranges "A-B" and steps "A-BxN" (each Nth from A to B), with commas between
/// them; whole numbers from 0 to 9,999,999. Empty: 1. Throws InputError.
FrameChoice chosenFrames(const std::string& option);

/// The same for a command that makes one picture.
int chosenFrame(const std::string& option, const std::string& command);

/// A file's name with the frame's number in the place of %d, or of %0Nd, with zeros in front to make N digits
/// (1 to 9); in a name without these, in the place of the last run of #, as many digits. %% becomes %. A name
/// without any of them stays as it is, and so does the folder's. Throws InputError for any other %.
std::string frameFile(const std::string& pattern, int frame);

/// Throws InputError where the files of several frames would have the same name: `option` names it.
void checkPattern(const std::string& pattern, const std::string& option);

}  // namespace luciole
