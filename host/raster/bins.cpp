#include "raster/bins.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>

namespace luciole {
namespace {

/// Calls `visit` with every bin that the triangle's box touches.
template <class Visit>
void forEachBin(const RasterTriangle& triangle, const Bins& bins, Visit visit) {
  const PixelBox box = pixelBox(triangle);
  // Division by a shift, since it must round down for pixels left of the picture too.
  static_assert(kBinSize == 1 << 6);
  const glm::ivec2 first = glm::max((box.first >> 6) - bins.first, glm::ivec2(0));
  const glm::ivec2 last = glm::min((box.last >> 6) - bins.first, bins.count - 1);
  for (int y = first.y; y <= last.y; ++y)
    for (int x = first.x; x <= last.x; ++x) visit(y * bins.count.x + x);
}

}  // namespace

Bins binTriangles(std::span<const RasterTriangle> triangles, const View& view,
                  std::span<const float> farthest) {
  Bins bins;
  bins.first = view.crop_origin / kBinSize;
  bins.count = (view.crop_origin + view.crop_size - 1) / kBinSize - bins.first + 1;
  const std::size_t list_count = 2 * std::size_t(bins.size());  // of each bin: opaque triangles, then others

  // Count, scan, fill, by runs of triangles: a run's entries of a bin follow those of the run before it. The
  // number of runs does not depend on the machine, and is bounded for the sake of the table of counts.
  const std::size_t run_size = std::max<std::size_t>(4096, triangles.size() / 64);
  const std::size_t runs = (triangles.size() + run_size - 1) / run_size;
  const auto triangles_of_run = [&](std::size_t run, auto visit) {
    const std::size_t end = std::min(triangles.size(), (run + 1) * run_size);
    for (std::size_t i = run * run_size; i < end; ++i) {
      const int kind = triangles[i].masked;
      forEachBin(triangles[i], bins, [&](int bin) {
        if (farthest.empty() || triangles[i].depth_high >= farthest[bin])
          visit(2 * bin + kind, std::uint32_t(i));
      });
    }
  };
  // [run][list]: first the count, then where to write next
  std::vector<std::size_t> places(runs * list_count);
  tbb::parallel_for(std::size_t(0), runs, [&](std::size_t run) {
    triangles_of_run(run, [&](int list, std::uint32_t) { ++places[run * list_count + list]; });
  });
  bins.starts.resize(list_count / 2 + 1);
  std::size_t total = 0;
  for (std::size_t list = 0; list < list_count; ++list) {
    if (list % 2 == 0) bins.starts[list / 2] = total;
    for (std::size_t run = 0; run < runs; ++run) {
      const std::size_t entries = places[run * list_count + list];
      places[run * list_count + list] = total;
      total += entries;
    }
  }
  bins.starts.back() = total;
  bins.triangles.resize(total);
  tbb::parallel_for(std::size_t(0), runs, [&](std::size_t run) {
    triangles_of_run(run, [&](int list, std::uint32_t triangle) {
      bins.triangles[places[run * list_count + list]++] = triangle;
    });
  });
  return bins;
}

}  // namespace luciole
