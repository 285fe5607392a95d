#pragma once

#include <string>

namespace luciole {

/// How a file of some extension stores pictures.
struct FileFormat {
  std::string extension;  ///< in lower case, without the dot
  bool is_float;
  int max_channels;  ///< 3: R G B; 4: and A; more: any channels under any names
};

/// The format of a file to write: `named`, an extension, or where that is empty by the path's own; PNG for
/// "-". What only OpenImageIO knows is taken for 8-bit R G B. Throws InputError for one that it doesn't
/// write.
FileFormat outputFormat(const std::string& path, const std::string& named = "");

/// Whether OpenImageIO makes files of this extension.
bool openImageIOWrites(const std::string& extension);

}  // namespace luciole
