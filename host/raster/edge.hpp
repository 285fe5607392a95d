#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include "raster/setup.hpp"

namespace luciole {

/// An edge of a triangle, from corner i to the next, and its function at a bin's first sample:
/// E(x, y) = dx · (y − y_a) − dy · (x − x_a), in 1/256 pixel. It is ≥ 0 at the samples on the inner side, at
/// those on the edge itself only where it is a left or a top edge, so that triangles sharing the edge never
/// both cover a sample.
struct Edge {
  std::int32_t dx, dy;
  std::int64_t at_origin;
};
inline Edge edgeOf(const RasterTriangle& triangle, int i, const glm::ivec2& bin_origin) {
  const int j = i == 2 ? 0 : i + 1;
  const std::int32_t dx = triangle.x[j] - triangle.x[i];
  const std::int32_t dy = triangle.y[j] - triangle.y[i];
  const bool left_or_top = dy < 0 || (dy == 0 && dx > 0);
  return {dx, dy,
          std::int64_t(dx) * (bin_origin.y * kSubpixels - triangle.y[i]) -
              std::int64_t(dy) * (bin_origin.x * kSubpixels - triangle.x[i]) - (left_or_top ? 0 : 1)};
}

/// ⌊E / 256⌋ beyond ±kFarEdge at a bin's first sample keeps its sign all over the bin.
constexpr std::int64_t kFarEdge = std::int64_t(1) << 30;

}  // namespace luciole
