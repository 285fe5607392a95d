#include "raster/bound_depth.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "raster/bins.hpp"
#include "raster/bound_bin.hpp"
#include "raster/bound_setup.hpp"
#include "raster/list_items.hpp"
#include "raster/placed_meshlets.hpp"

namespace luciole {
namespace {

/// Calls `visit` with every bin that the piece may touch a grown texel of.
template <class Visit>
void forEachBin(const BoundPiece& piece, const BinGrid& bins, Visit visit) {
  const auto binOf = [](double place, int first, int count) {
    return int(std::clamp(std::floor((place + 0.5) / kBinSize) - first, -1.0, double(count)));
  };
  const int left = std::max(binOf(piece.low.x - 1, bins.first.x, bins.count.x), 0);
  const int right = std::min(binOf(piece.high.x + 1, bins.first.x, bins.count.x), bins.count.x - 1);
  const int top = std::max(binOf(piece.low.y - 1, bins.first.y, bins.count.y), 0);
  const int bottom = std::min(binOf(piece.high.y + 1, bins.first.y, bins.count.y), bins.count.y - 1);
  for (int y = top; y <= bottom; ++y)
    for (int x = left; x <= right; ++x) visit(y * bins.count.x + x);
}

}  // namespace

void rasterizeBounds(const Scene& scene, const Meshlets& meshlets, std::span<const std::uint32_t> chosen,
                     const View& view, std::span<const float> farthest, std::span<BoundTexel> texels) {
  const BoundSetup setup =
      setupBounds(scene, placeMeshlets(scene, meshlets, chosen, view.world_to_view), view);
  const BinGrid grid = binGrid(view);
  const auto isDrawn = [&](int bin) { return farthest.empty() || std::isfinite(farthest[bin]); };
  const ItemLists lists =
      listItems(setup.pieces.size(), std::size_t(grid.size()), [&](std::size_t i, auto visit) {
        const BoundPiece& piece = setup.pieces[i];
        const float nearest = roundUp(piece.high.z + piece.depth_error);
        forEachBin(piece, grid, [&](int bin) {
          if (farthest.empty() || (isDrawn(bin) && nearest >= farthest[bin])) visit(std::size_t(bin));
        });
      });
  tbb::parallel_for(0, grid.size(), [&](int index) {
    if (!isDrawn(index)) return;
    const auto bin = std::make_unique<BoundBin>();
    clearBin(grid.origin(index), setup.unknown, *bin);
    for (const std::uint32_t i : lists.list(index))
      if (setup.pieces[i].covering) drawPlane(setup.pieces[i], *bin);
    for (const std::uint32_t i : lists.list(index)) drawOther(setup.pieces[i], *bin);
    forEachRow(view, bin->origin, [&](int in_bin, std::size_t in_crop, int count) {
      std::copy_n(bin->texels.begin() + in_bin, count, texels.begin() + std::ptrdiff_t(in_crop));
    });
  });
}

}  // namespace luciole
