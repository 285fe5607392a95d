#pragma once

#include <glm/glm.hpp>
#include <memory>
#include <string>
#include <vector>

#include "image/image.hpp"

namespace luciole {

/// All channels of a file as float, without any conversion of colours.
struct LayerFile {
  std::string path;
  glm::ivec2 size{0};
  glm::ivec2 picture_size{0};  ///< of the whole picture, of which this may be a crop
  glm::ivec2 crop_origin{0};   ///< where in the whole picture pixel (0,0) lies
  std::vector<std::string> channels;
  /// size.x × size.y × channels, row-major, channels interleaved. Allocated uninitialized, so that rows that
  /// a damaged file claims but doesn't hold take no memory.
  std::unique_ptr<float[]> values;
  ExrAttributes attributes;  ///< texts and 4 × 4 float matrices; upper and lower case of names vary
};

/// What the header of a part of a picture file says. Most files are of one part.
struct PicturePart {
  std::string name;                                     ///< of a part of an EXR; may be empty
  glm::ivec2 size{0}, picture_size{0}, crop_origin{0};  ///< as in LayerFile
  std::vector<std::string> channels;
  std::vector<std::string> types;  ///< of each channel: "half", "float", "uint8" …
  std::string compression;         ///< by its name in OpenImageIO; empty where the format knows none
  ExrAttributes attributes;        ///< as in LayerFile
};

/// Reads the headers of a picture file, of any format that OpenImageIO reads. Of an EXR whose pixels lie in
/// rows it reads the first and the last row too, so that one that ends early is told. Throws InputError.
std::vector<PicturePart> readParts(const std::string& path);

/// Reads the first part of a file, of any format that OpenImageIO reads. Sizes are checked before anything is
/// allocated. Throws InputError, or MachineError where it doesn't fit into memory.
LayerFile readLayers(const std::string& path);

}  // namespace luciole
