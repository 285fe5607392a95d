#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cl/program.hpp"

// A folder with the binaries of programs, a file each, for platforms that compile anew in every run. A file
// is named by a hash of all that its binary depends on, and holds that as well, so that two of one hash
// aren't confused, and a checksum. Files appear whole, so any number of processes may use a folder at once.
namespace luciole {

/// What is kept of a program.
struct KeptProgram {
  std::vector<unsigned char> binary;
  KernelArguments arguments;  ///< of all its kernels
};

/// luciole/`kind` in $XDG_CACHE_HOME or, without that, in $HOME/.cache. Empty if there is neither.
std::string userCache(const char* kind);

/// Where the user's programs are kept: userCache("programs").
std::string userProgramCache();

/// The program kept under this description, and marks it as used. Empty if there is none, or if its file is
/// damaged.
std::optional<KeptProgram> findProgram(const std::string& folder, const std::string& description);

/// Keeps a program, in place of one of the same description, and makes the folder where it is missing. The
/// programs that were used longest ago are removed until all take at most `most_bytes`. A folder that can't
/// be written to stays as it is, which is no error.
void keepProgram(const std::string& folder, const std::string& description, const KeptProgram& program,
                 std::uintmax_t most_bytes = 64 << 20);

}  // namespace luciole
