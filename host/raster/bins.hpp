#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "raster/setup.hpp"
#include "raster/view.hpp"

namespace luciole {

constexpr int kBinSize = 64;  ///< pixels a side

/// For every square of kBinSize² pixels that the crop touches, the triangles whose bounding boxes touch it:
/// the opaque ones in order, then those with holes, which are looked for only where nothing nearer is. Bins
/// are aligned to the whole picture, so that a crop only takes some of them.
struct Bins {
  glm::ivec2 first;                      ///< bin of the whole picture: the top left one here
  glm::ivec2 count;                      ///< columns and rows
  std::vector<std::size_t> starts;       ///< of each bin's list, row by row, and the end of the last
  std::vector<std::uint32_t> triangles;  ///< indices into the triangles given

  int size() const { return count.x * count.y; }
  glm::ivec2 origin(int bin) const { return (first + glm::ivec2(bin % count.x, bin / count.x)) * kBinSize; }
  std::span<const std::uint32_t> list(int bin) const {
    return std::span(triangles).subspan(starts[bin], starts[bin + 1] - starts[bin]);
  }
};

/// `farthest`: one a bin, the smallest reversed depth that matters there: triangles that stay below it are
/// left out. Empty: all matter.
Bins binTriangles(std::span<const RasterTriangle> triangles, const View& view,
                  std::span<const float> farthest = {});

}  // namespace luciole
