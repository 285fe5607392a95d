#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/cleanup.hpp"

namespace luciole {

/// A folder for temporary files, which the destructor, or cleanUp(), removes with all that is in it. The
/// constructor throws MachineError if it can't make one.
class ScratchFolder {
 public:
  ScratchFolder();
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  std::string operator/(const std::string& name) const { return (path_ / name).string(); }

 private:
  void remove() const;

  std::filesystem::path path_;
  std::optional<Cleanup> cleanup_;
};

/// Variables of an environment, and their values.
using Environment = std::vector<std::pair<std::string, std::string>>;

/// Variables by which platforms keep the kernels that they compile in this folder.
Environment kernelCacheIn(const ScratchFolder& folder);

/// Options that make another run of luciole take as many threads as this process may.
std::vector<std::string> sameThreads();

/// Runs a program and waits for its end. environment: variables that are set in addition to the caller's.
/// Returns the milliseconds from its start to its end. Throws MachineError if it can't be run, or with the
/// first line that it wrote to standard error if its exit status isn't 0.
double runChild(const std::string& program, const std::vector<std::string>& arguments,
                const Environment& environment);

}  // namespace luciole
