#pragma once

#include <glm/glm.hpp>
#include <memory>
#include <string>
#include <vector>

#include "image/image.hpp"

namespace luciole {

/// All channels of a file as float, as it has them: no colour is converted.
struct LayerFile {
  std::string path;
  glm::ivec2 size{0};
  glm::ivec2 picture_size{0};  ///< of the whole picture, of which this may be a crop
  glm::ivec2 crop_origin{0};   ///< where in the whole picture pixel (0,0) lies
  std::vector<std::string> channels;
  /// size.x × size.y × channels, row-major, channels interleaved. Made unwritten, so that what a damaged file
  /// promises and doesn't hold takes no memory.
  std::unique_ptr<float[]> values;
  ExrAttributes attributes;  ///< texts and 4 × 4 float matrices; what other programs wrote in any case
};

/// Reads the first part of a file, of any format that OpenImageIO reads. Sizes are checked before anything is
/// allocated. Throws InputError, or MachineError where it doesn't fit into memory.
LayerFile readLayers(const std::string& path);

}  // namespace luciole
