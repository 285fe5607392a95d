#pragma once

#include <optional>
#include <string>
#include <vector>

namespace luciole {

/// Where the files lie that a file names.
struct SearchFolders {
  std::string folder{};               ///< of the file that names them; "": the current one
  std::vector<std::string> others{};  ///< looked in afterwards, in this order
};

/// The path of the file that `name` means: in `folder`, or absolute. Backslashes are tried as slashes. A file
/// that isn't there, such as one by its path on another machine, is looked for by the last part of its name
/// in `folder`, then in each of the others by its whole name and by its last part. A name that is no UTF-8 is
/// tried as Latin-1 afterwards. Nothing where there is no such file anywhere.
std::optional<std::string> findFile(const std::string& name, const SearchFolders& where);

}  // namespace luciole
