#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace luciole {

/// A folder for temporary files, removed with all that is in it. Throws MachineError where none can be made.
class ScratchFolder {
 public:
  ScratchFolder();
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  std::string operator/(const std::string& name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

/// Runs a program, with these variables in its environment and nothing on its standard streams, and waits for
/// its end. Returns the milliseconds from its start to its end. Throws MachineError unless its exit status
/// is 0, with the first line that it said on standard error.
double runChild(const std::string& program, const std::vector<std::string>& arguments,
                const std::vector<std::pair<std::string, std::string>>& environment);

}  // namespace luciole
