#include "raster/bins.hpp"

namespace luciole {
namespace {

/// Calls `visit` with every bin that the triangle's box touches.
template <class Visit>
void forEachBin(const RasterTriangle& triangle, const glm::ivec2& reach, const BinGrid& bins, Visit visit) {
  const PixelBox box = pixelBox(triangle, reach);
  // A shift rounds down for negative pixels, left of the picture, too; division doesn't.
  static_assert(kBinSize == 1 << 6);
  const glm::ivec2 first = glm::max((box.first >> 6) - bins.first, glm::ivec2(0));
  const glm::ivec2 last = glm::min((box.last >> 6) - bins.first, bins.count - 1);
  for (int y = first.y; y <= last.y; ++y)
    for (int x = first.x; x <= last.x; ++x) visit(y * bins.count.x + x);
}

}  // namespace

BinGrid binGrid(const View& view) {
  const glm::ivec2 first = view.crop_origin / kBinSize;
  return {first, (view.crop_origin + view.crop_size - 1) / kBinSize - first + 1};
}

Bins binTriangles(std::span<const RasterTriangle> triangles, const View& view,
                  std::span<const float> farthest) {
  const BinGrid grid = binGrid(view);
  return {grid, listItems(triangles.size(), 2 * std::size_t(grid.size()), [&](std::size_t i, auto visit) {
            const int kind = triangles[i].masked;
            forEachBin(triangles[i], view.reach, grid, [&](int bin) {
              if (farthest.empty() || triangles[i].depth_high >= farthest[bin])
                visit(2 * std::size_t(bin) + kind);
            });
          })};
}

}  // namespace luciole
