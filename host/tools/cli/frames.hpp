#pragma once

#include <string>
#include <vector>

namespace luciole {

/// The frames that --frames names.
struct FrameChoice {
  std::vector<int> frames{1};  ///< in the order typed, none twice
  bool is_list = false;        ///< typed as a list or range: each picture's name contains its frame's number
};

/// Parses --frames: frames "A", ranges "A-B" and steps "A-BxN" (every Nth from A to B), separated by commas.
/// Numbers are from 0 to 9,999,999. An empty option means frame 1. Throws InputError.
FrameChoice chosenFrames(const std::string& option);

/// The frame that --frames names for a command that makes one picture. Throws InputError, also for a list.
/// command: its name, for the message.
int chosenFrame(const std::string& option, const std::string& command);

/// The file's name for a frame. The number replaces %d, or %0Nd by at least N digits (1 to 9), with zeros in
/// front. In a name without these it replaces the last run of #, by at least as many digits. %% becomes %. A
/// name without any of them doesn't change, and the folder's name never does. Throws InputError for another
/// %.
std::string frameFile(const std::string& pattern, int frame);

/// Throws InputError if all frames' files would have the same name, because the pattern has no place for the
/// number. option: the pattern's option, for the message.
void checkPattern(const std::string& pattern, const std::string& option);

/// The pattern with # for each digit of the number: the same for all that name the same files.
std::string hashPattern(const std::string& pattern);

/// Whether a file's name has a place for the frame's number. Throws InputError as frameFile() does.
bool hasFramePlace(const std::string& pattern);

/// The frames, in rising order, whose files are there: those that frameFile() names for the pattern, which
/// has a place for the number. Empty also where there is no such folder.
std::vector<int> framesThere(const std::string& pattern);

/// Frames as text with ranges: "3, 7-9" for 3 7 8 9.
std::string listFrames(const std::vector<int>& frames);

}  // namespace luciole
