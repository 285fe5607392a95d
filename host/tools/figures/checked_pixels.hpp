#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace luciole {

/// The pixels of a picture that are compared with the reference: a random one in each cell of side × side
/// pixels, so that they cover the whole picture.
struct CheckedPixels {
  int side = 1;
  glm::ivec2 cells{0};
  std::vector<glm::ivec2> pixels;  ///< one for each cell, row by row
};

/// About `count` pixels of a picture of this size. The same seed gives the same pixels.
CheckedPixels chooseCheckedPixels(const glm::ivec2& size, std::size_t count, std::uint64_t seed);

}  // namespace luciole
