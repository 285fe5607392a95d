#pragma once

#include <string>

namespace luciole {

/// How a file of some extension stores pictures.
struct FileFormat {
  std::string extension;  ///< in lower case, without the dot
  bool is_float;
  int max_channels;  ///< 3: R G B; 4: and A; more: any channels under any names
};

/// What `named` or else the path's extension says, in lower case and without the dot; may be empty.
std::string formatName(const std::string& path, const std::string& named = "");

/// The format of a file to write. `named` is an extension; where it is empty the path's own counts, and for
/// "-" PNG. A format that only OpenImageIO knows is taken for 8-bit R G B. Throws InputError for one that
/// OpenImageIO doesn't write.
FileFormat outputFormat(const std::string& path, const std::string& named = "");

/// Whether OpenImageIO writes files of this extension (lower case, no dot).
bool openImageIOWrites(const std::string& extension);

}  // namespace luciole
