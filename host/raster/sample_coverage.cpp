#include "raster/sample_coverage.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <limits>
#include <optional>

#include "raster/edge.hpp"

namespace luciole {
namespace {

constexpr int kVector = 16;  ///< samples that are drawn together, as SIMD lanes

/// The lanes of a block: the samples of one pixel or, where there are fewer than kVector, those of several
/// pixels of a row.
struct Block {
  int pixels;
  int lanes;
  std::vector<std::int32_t> x;  ///< from the sample origin of the block's first pixel, 1/256 pixel
  std::vector<std::int32_t> y;
};

Block makeBlock(const SamplePattern& pattern) {
  Block block{std::max(kVector / pattern.stride, 1), std::max(kVector, pattern.stride), {}, {}};
  for (int lane = 0; lane < block.lanes; ++lane) {
    block.x.push_back(pattern.x[lane % pattern.stride] + lane / pattern.stride * kSubpixels);
    block.y.push_back(pattern.y[lane % pattern.stride]);
  }
  return block;
}

/// A triangle's values at the samples of the bin's first block.
struct TriangleTables {
  template <class T>
  using Table = StripSamples::Table<T>;

  /// Edge functions as in coverage.cpp, ⌊E / 256⌋ at each sample: from one block to another they change by
  /// integers, since whole pixels are 256 units.
  std::array<Table<std::int32_t>, 3> edges;
  std::array<std::int32_t, 3> most;  ///< the largest entry of each
  std::array<std::int32_t, 3> step_x, step_y;
  Table<float> depth;  ///< from the sample origin of the block's first pixel to the sample

  explicit TriangleTables(const Block& block) {
    for (Table<std::int32_t>& edge : edges) edge.resize(block.lanes);
    depth.resize(block.lanes);
  }
};

void setTables(const RasterTriangle& triangle, const glm::ivec2& bin_origin, const Block& block,
               TriangleTables& tables) {
  for (int i = 0; i < 3; ++i) {
    const auto [dx, dy, value] = edgeOf(triangle, i, bin_origin);
    const std::int32_t whole = std::int32_t(std::clamp(value >> kSubpixelBits, -kFarEdge, kFarEdge));
    const std::int32_t rest = std::int32_t(value & (kSubpixels - 1));
    // To the sample it is dx · y − dy · x more, too much for 32 bits: 256 times a part of it is split off.
    const std::int32_t dx_high = dx >> kSubpixelBits, dx_low = dx & (kSubpixels - 1);
    const std::int32_t dy_high = dy >> kSubpixelBits, dy_low = dy & (kSubpixels - 1);
    const std::int32_t* x = block.x.data();
    const std::int32_t* y = block.y.data();
    std::int32_t* edge = tables.edges[i].data();
    std::int32_t most = -std::numeric_limits<std::int32_t>::max();
    for (int first = 0; first < block.lanes; first += kVector)
      for (int lane = first; lane < first + kVector; ++lane) {
        edge[lane] = whole + (dx_high * y[lane] - dy_high * x[lane]) +
                     ((rest + dx_low * y[lane] - dy_low * x[lane]) >> kSubpixelBits);
        most = std::max(most, edge[lane]);
      }
    tables.most[i] = most;
    tables.step_x[i] = -dy;
    tables.step_y[i] = dx;
  }
  const float step_x = float(triangle.depth_dx / kSubpixels), step_y = float(triangle.depth_dy / kSubpixels);
  const std::int32_t* x = block.x.data();
  const std::int32_t* y = block.y.data();
  float* depth = tables.depth.data();
  for (int first = 0; first < block.lanes; first += kVector)
    for (int lane = first; lane < first + kVector; ++lane)
      depth[lane] = step_x * float(x[lane]) + step_y * float(y[lane]);
}

/// kVector samples of a block, and a triangle's values there.
struct Samples {
  std::array<std::int32_t, 3> edges;  ///< to be added to edge_tables
  std::array<const std::int32_t*, 3> edge_tables;
  float start;  ///< to be added to depth_table
  const float* depth_table;
  float low, high;  ///< the triangle's range of depth
  float* depth;     ///< as in StripSamples
  std::uint32_t* label;
};

/// The samples that a triangle covers, and its depth there.
struct Covered {
  alignas(64) std::array<std::int32_t, kVector> inside;
  alignas(64) std::array<float, kVector> z;
};

inline Covered cover(const Samples& at) {
  Covered covered;
  for (int lane = 0; lane < kVector; ++lane) {
    covered.inside[lane] =
        ((at.edges[0] + at.edge_tables[0][lane]) | (at.edges[1] + at.edge_tables[1][lane]) |
         (at.edges[2] + at.edge_tables[2][lane])) >= 0;
    covered.z[lane] = std::min(std::max(at.start + at.depth_table[lane], at.low), at.high);
  }
  return covered;
}

/// Draws an opaque triangle to the samples where it is the nearest. Returns whether it covers any, visible or
/// not.
inline bool takeOpaque(const Samples& at, std::uint32_t number) {
  const Covered covered = cover(at);
  alignas(64) std::array<float, kVector> depth;
  alignas(64) std::array<std::uint32_t, kVector> label;
  std::copy(at.depth, at.depth + kVector, depth.begin());
  std::copy(at.label, at.label + kVector, label.begin());
  std::int32_t any = 0;
  for (int lane = 0; lane < kVector; ++lane) {
    const bool seen = covered.inside[lane] & std::int32_t(covered.z[lane] > depth[lane]);
    any |= covered.inside[lane];
    depth[lane] = seen ? covered.z[lane] : depth[lane];
    label[lane] = seen ? number : label[lane];
  }
  std::copy(depth.begin(), depth.end(), at.depth);
  std::copy(label.begin(), label.end(), at.label);
  return any != 0;
}

/// The same for a triangle with holes; isOpen(lane): it has a hole at the sample.
template <class IsOpen>
bool takeMasked(const Samples& at, std::uint32_t number, IsOpen isOpen) {
  const Covered covered = cover(at);
  bool any = false;
  for (int lane = 0; lane < kVector; ++lane) {
    if (!covered.inside[lane]) continue;
    any = true;
    const float z = covered.z[lane];
    // As in coverage.cpp: at equal depth the lower number wins, and a depth of 0 is nothing.
    const bool nearer = z > at.depth[lane] || (z == at.depth[lane] && number < at.label[lane] && z > 0.0f);
    if (!nearer || isOpen(lane)) continue;
    at.depth[lane] = z;
    at.label[lane] = number;
  }
  return any;
}

/// A triangle on the rows of a strip.
struct StripTarget {
  const RasterTriangle& triangle;
  const TriangleTables& tables;
  const Block& block;
  glm::ivec2 bin_origin;
};

/// Calls take(samples, pixel, lane) for all samples of a box of the bin's pixels, kVector at a time; blocks
/// that the triangle can't cover are left out. pixel: the block's first one, in the bin; lane: of the block.
/// Returns whether it ever returned true.
template <class Take>
bool forEachVector(const StripTarget& target, const PixelBox& box, StripSamples& samples, Take take) {
  const auto& [triangle, tables, block, bin_origin] = target;
  const int stride = block.lanes / block.pixels;
  bool any = false;
  for (int y = box.first.y; y <= box.last.y; ++y) {
    for (int x = box.first.x / block.pixels * block.pixels; x <= box.last.x; x += block.pixels) {
      std::array<std::int32_t, 3> edges;
      for (int i = 0; i < 3; ++i) edges[i] = tables.step_x[i] * x + tables.step_y[i] * y;
      if (((edges[0] + tables.most[0]) | (edges[1] + tables.most[1]) | (edges[2] + tables.most[2])) < 0)
        continue;
      const float start = float(triangle.depth + triangle.depth_dx * (bin_origin.x + x) +
                                triangle.depth_dy * (bin_origin.y + y));
      const std::size_t first = (std::size_t(y - samples.first_row) * kBinSize + x) * std::size_t(stride);
      for (int lane = 0; lane < block.lanes; lane += kVector) {
        const Samples at{
            edges,
            {tables.edges[0].data() + lane, tables.edges[1].data() + lane, tables.edges[2].data() + lane},
            start,
            tables.depth.data() + lane,
            triangle.depth_low,
            triangle.depth_high,
            samples.depth.data() + first + lane,
            samples.label.data() + first + lane};
        any |= take(at, glm::ivec2(x, y), lane);
      }
    }
  }
  return any;
}

bool drawMaskedSamples(const StripTarget& target, const PixelBox& box, const HoleTest& holes,
                       const SamplePattern& pattern, StripSamples& samples) {
  const std::uint32_t number = target.triangle.triangle;
  std::optional<Surface> surface;
  return forEachVector(target, box, samples, [&](const Samples& at, const glm::ivec2& pixel, int first_lane) {
    return takeMasked(at, number, [&](int lane_of_vector) {
      const int lane = first_lane + lane_of_vector;
      if (lane % pattern.stride >= pattern.count) return true;  // an entry that stands for no sample
      if (!surface) surface = makeSurface(holes.scene, holes.objects, number, holes.plane);
      const glm::dvec2 place = glm::dvec2(target.bin_origin + pixel) +
                               glm::dvec2(target.block.x[lane], target.block.y[lane]) / double(kSubpixels);
      return isHole(holes.scene, *surface, holes.plane, place,
                    target.bin_origin + pixel + glm::ivec2(lane / pattern.stride, 0),
                    {lane % pattern.stride, pattern.count});
    });
  });
}

}  // namespace

int stripRows(const SamplePattern& pattern) {
  int rows = kBinSize;
  while (rows > 1 && rows * pattern.stride > 1024) rows /= 2;
  return rows;
}

void drawStrip(std::span<const RasterTriangle> triangles, const Bins& bins, int bin, int first_row,
               const HoleTest& holes, const SamplePattern& pattern, std::span<std::uint8_t> covering,
               StripSamples& samples) {
  const int rows = stripRows(pattern);
  const std::size_t entries = std::size_t(rows) * kBinSize * std::size_t(pattern.stride);
  samples.first_row = first_row;
  samples.depth.assign(entries, 0.0f);
  samples.label.assign(entries, kNoTriangle);
  const Block block = makeBlock(pattern);
  TriangleTables tables(block);
  const glm::ivec2 origin = bins.origin(bin);
  const std::span<const std::uint32_t> list = bins.list(bin);
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (i + 8 < list.size()) __builtin_prefetch(&triangles[list[i + 8]]);
    const RasterTriangle& triangle = triangles[list[i]];
    const PixelBox whole = pixelBox(triangle, pattern.reach);
    const PixelBox box{glm::max(whole.first - origin, glm::ivec2(0, first_row)),
                       glm::min(whole.last - origin, glm::ivec2(kBinSize - 1, first_row + rows - 1))};
    if (box.first.y > box.last.y) continue;
    setTables(triangle, origin, block, tables);
    const StripTarget target{triangle, tables, block, origin};
    const bool covered =
        triangle.masked ? drawMaskedSamples(target, box, holes, pattern, samples)
                        : forEachVector(target, box, samples, [&](const Samples& at, const glm::ivec2&, int) {
                            return takeOpaque(at, triangle.triangle);
                          });
    // Several bins may write it at once.
    if (covered) std::atomic_ref(covering[triangle.triangle]).store(1, std::memory_order_relaxed);
  }
}

}  // namespace luciole
