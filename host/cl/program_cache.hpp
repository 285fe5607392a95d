#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cl/program.hpp"

// A folder of program binaries, a file each, for platforms without a cache of their own. A file's name is a
// hash of everything that its binary depends on. It also contains that text, against collisions of hashes,
// and a checksum. Files appear whole, so any number of processes may use a folder at once.
namespace luciole {

/// A cached program.
struct KeptProgram {
  std::vector<unsigned char> binary;
  KernelArguments arguments;  ///< of all its kernels
};

/// FNV-1a (Fowler, Noll, Vo) of 64 bits, as 16 hexadecimal digits.
std::string hashOf(std::string_view bytes);

/// luciole/`kind` in $XDG_CACHE_HOME or, without that, in $HOME/.cache. Empty if there is neither.
std::string userCache(const char* kind);

/// Where the user's programs are kept: userCache("programs").
std::string userProgramCache();

/// The cached program of this description. Marks it as used. Empty if there is none, or if its file is
/// damaged.
std::optional<KeptProgram> findProgram(const std::string& folder, const std::string& description);

/// Stores a program, replacing one of the same description, and makes the folder if it is missing. Then
/// removes the least recently used programs until all take at most `most_bytes`. A folder that can't be
/// written to is no error.
void keepProgram(const std::string& folder, const std::string& description, const KeptProgram& program,
                 std::uintmax_t most_bytes = 64 << 20);

}  // namespace luciole
