#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>

#include "raster/list_items.hpp"
#include "raster/setup.hpp"
#include "raster/view.hpp"

namespace luciole {

constexpr int kBinSize = 64;  ///< pixels a side

/// The squares of kBinSize² pixels that a view's crop touches, row by row. Bins are aligned to the whole
/// picture, so that a crop only takes some of them.
struct BinGrid {
  glm::ivec2 first;  ///< bin of the whole picture: the top left one here
  glm::ivec2 count;  ///< columns and rows

  int size() const { return count.x * count.y; }
  /// The bin's top left pixel, in the whole picture.
  glm::ivec2 origin(int bin) const { return (first + glm::ivec2(bin % count.x, bin / count.x)) * kBinSize; }
};
/// The bins that a view's crop touches.
BinGrid binGrid(const View& view);

/// Calls visit(in_bin, in_crop, count) for each row of a bin's pixels in the crop: the indices of its first
/// pixel in the bin and in the crop, both row by row, and its number of pixels.
template <class Visit>
void forEachRow(const View& view, const glm::ivec2& bin_origin, Visit visit) {
  const glm::ivec2 first = glm::max(bin_origin, view.crop_origin);
  const glm::ivec2 end = glm::min(bin_origin + kBinSize, view.crop_origin + view.crop_size);
  for (int y = first.y; y < end.y; ++y)
    visit((y - bin_origin.y) * kBinSize + first.x - bin_origin.x,
          std::size_t(y - view.crop_origin.y) * view.crop_size.x + (first.x - view.crop_origin.x),
          end.x - first.x);
}

/// For every bin the triangles whose bounding boxes touch it: first opaque triangles, in order, then those
/// with holes. So opacity is looked up only where these are the nearest.
struct Bins : BinGrid {
  ItemLists
      lists;  ///< indices into the triangles given; two lists a bin: opaque triangles, then those with holes

  std::span<const std::uint32_t> list(int bin) const {
    const std::size_t start = lists.starts[2 * std::size_t(bin)],
                      end = lists.starts[2 * std::size_t(bin) + 2];
    return std::span(lists.items).subspan(start, end - start);
  }
};

/// Puts triangles into the bins of the view's crop. `farthest`: for each bin, row by row, the smallest
/// reversed depth that is needed; triangles that are farther away everywhere are left out. Empty: no limit.
/// O(triangles · bins that each touches), in parallel.
Bins binTriangles(std::span<const RasterTriangle> triangles, const View& view,
                  std::span<const float> farthest = {});

}  // namespace luciole
