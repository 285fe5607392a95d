#pragma once

#include <memory>
#include <optional>
#include <string>

#include "image/row_file.hpp"
#include "luciole/image.hpp"

// Bare arrays of floats, which OpenImageIO doesn't know or doesn't write in all versions.
//
//   .pfm  "PF\nWIDTH HEIGHT\n-1.0\n", then R G B of each pixel as little-endian 32-bit floats, rows from the
//         bottom up (P. Debevec's portable float map)
//   .npy  NumPy's format 1.0: an array of shape (height, width, channels) of '<f4', rows from the top down
namespace luciole {

/// A file of `format.extension` pfm (3 channels) or npy, of 32-bit floats as they are. A PFM that goes to a
/// stream, which can't begin at the bottom, is kept in memory until close(). Throws as writeImage does.
std::unique_ptr<RowFile> openFloatFile(const std::string& path, int width, int height, int channels,
                                       const FileFormat& format);

/// A .npy file's picture: an array of shape (height, width), which becomes a channel Y, or
/// (height, width, 1, 3 or 4) of '<f4' or '<f8', in C order. Empty where the file is none. Sizes are checked
/// before anything is allocated. Throws InputError, MachineError where it doesn't fit into memory.
std::optional<Image> readNpy(const std::string& path);

}  // namespace luciole
