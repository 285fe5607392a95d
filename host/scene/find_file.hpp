#pragma once

#include <optional>
#include <string>
#include <vector>

namespace luciole {

/// The folders in which files that a file names are searched.
struct SearchFolders {
  std::string folder{};               ///< of the file that names them; "": the current one
  std::vector<std::string> others{};  ///< searched next, in this order
};

/// The path of the file called `name`, absolute or relative to `folder`. If there is none, such as for a path
/// of another machine, tries the last part of the name in `folder`, then in each of the others the whole name
/// and its last part. Backslashes are tried as slashes. Last, a name that isn't UTF-8 is tried as Latin-1.
/// Empty if no file is found.
std::optional<std::string> findFile(const std::string& name, const SearchFolders& where);

}  // namespace luciole
