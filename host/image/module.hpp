#pragma once

#include <span>
#include <string>

#include "base/cleanup.hpp"
#include "image/file_format.hpp"
#include "image/heat_map.hpp"
#include "image/layers.hpp"
#include "image/read_texture.hpp"
#include "image/row_file.hpp"
#include "image/side_by_side.hpp"
#include "luciole/image.hpp"

// OpenImageIO brings some 260 libraries along, which take the dynamic loader 0.2 s. So what includes it is a
// module of its own, which the library loads when it first reads a picture, or writes one that is neither PNG
// nor EXR:
//
//   library:  readImage() of module.cpp ──► ImageFunctions::read_image ──► module:  readImage() of image.cpp
namespace luciole {

/// The functions of this folder that the module has, as their headers describe them.
struct ImageFunctions {
  decltype(&readImage) read_image;
  decltype(&readAttribute) read_attribute;
  decltype(&openPictureFile) open_picture_file;
  decltype(&readParts) read_parts;
  Texture (*read_texture)(const std::string& path);
  Texture (*read_texture_in_memory)(std::span<const std::byte> file, const std::string& name);
  decltype(&errorMap) error_map;
  decltype(&listMap) list_map;
  decltype(&boundMap) bound_map;
  decltype(&valueSheet) value_sheet;
  decltype(&sideBySide) side_by_side;
  decltype(&labelledSheet) labelled_sheet;
  decltype(&openImageIOWrites) open_image_io_writes;
  decltype(&shareCleanups) use_cleanups;
};

/// The module's only symbol.
extern "C" __attribute__((visibility("default"))) const ImageFunctions luciole_image_functions;

}  // namespace luciole
