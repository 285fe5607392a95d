#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace luciole {

/// The positions of a pixel's samples that are drawn in one pass: samplePoint(), rounded to 1/256 pixel.
struct SamplePattern {
  int count = 1;
  /// Entries a pixel in tables of samples: `count` rounded up to 2, 4, 8 or a multiple of 16, so that pixels
  /// fill whole SIMD vectors. The entries from `count` on repeat the last sample.
  int stride = 2;
  glm::dvec2 origin{0.5};       ///< the least x and the least y of all samples, in pixels: their View::sample
  glm::ivec2 reach{0};          ///< the greatest x and y, from `origin`, in 1/256 pixel: their View::reach
  std::vector<std::int32_t> x;  ///< from `origin`, in 1/256 pixel; `stride` of them
  std::vector<std::int32_t> y;
};

/// The pattern of `count` samples a pixel, 1 or more.
SamplePattern samplePattern(int count);

}  // namespace luciole
