#include "raster/sample_coverage.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
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
  glm::ivec2 reach;  ///< the largest of them
};

Block makeBlock(const SamplePattern& pattern) {
  Block block{
      std::max(kVector / pattern.stride, 1), std::max(kVector, pattern.stride), {}, {}, pattern.reach};
  block.reach.x += (block.pixels - 1) * kSubpixels;
  for (int lane = 0; lane < block.lanes; ++lane) {
    block.x.push_back(pattern.x[lane % pattern.stride] + lane / pattern.stride * kSubpixels);
    block.y.push_back(pattern.y[lane % pattern.stride]);
  }
  return block;
}

/// A triangle's values at the samples of the bin's first block.
struct TriangleTables {
  /// Edge functions as in coverage.cpp, ⌊E / 256⌋ at each sample: from one block to another they change by
  /// integers, since whole pixels are 256 units.
  std::array<RawArray<std::int32_t>, 3> edges;
  std::array<std::int32_t, 3> most;  ///< an upper bound of the entries of each
  std::array<std::int32_t, 3> step_x, step_y;
  RawArray<float> depth;  ///< from the sample origin of the block's first pixel to the sample

  explicit TriangleTables(const Block& block) {
    for (RawArray<std::int32_t>& edge : edges) edge.resize(block.lanes);
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
    for (int first = 0; first < block.lanes; first += kVector)
      for (int lane = first; lane < first + kVector; ++lane) {
        edge[lane] = whole + (dx_high * y[lane] - dy_high * x[lane]) +
                     ((rest + dx_low * y[lane] - dy_low * x[lane]) >> kSubpixelBits);
      }
    // At the corner of the block's samples that is farthest inside.
    tables.most[i] = whole + std::int32_t((rest + std::int64_t(std::max(dx, 0)) * block.reach.y +
                                           std::int64_t(std::max(-dy, 0)) * block.reach.x) >>
                                          kSubpixelBits);
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

/// Draws an opaque triangle to the samples where it is the nearest. Sets `any` of the lanes that it covers,
/// visible or not, to 1.
inline void takeOpaque(const Samples& at, std::uint32_t number, std::array<std::int32_t, kVector>& any) {
  const Covered covered = cover(at);
  alignas(64) std::array<float, kVector> depth;
  alignas(64) std::array<std::uint32_t, kVector> label;
  std::copy(at.depth, at.depth + kVector, depth.begin());
  std::copy(at.label, at.label + kVector, label.begin());
  for (int lane = 0; lane < kVector; ++lane) {
    const bool seen = covered.inside[lane] & std::int32_t(covered.z[lane] > depth[lane]);
    any[lane] |= covered.inside[lane];
    depth[lane] = seen ? covered.z[lane] : depth[lane];
    label[lane] = seen ? number : label[lane];
  }
  std::copy(depth.begin(), depth.end(), at.depth);
  std::copy(label.begin(), label.end(), at.label);
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

constexpr int kGroupSide = 4;  ///< blocks in a row and in a column that are tested together, as SIMD lanes

/// Those of kGroupSide places from `start` on that lie in first to last, so many bits each.
std::uint32_t placesWithin(int start, int first, int last, int bits) {
  const int from = std::max(first - start, 0), end = std::min(last - start + 1, kGroupSide);
  return (1u << end * bits) - (1u << from * bits);
}

/// Calls take(samples, pixel, lane) for all samples of a box of the bin's pixels, kVector at a time; blocks
/// that the triangle can't cover are left out. pixel: the block's first one, in the bin; lane: of the block.
template <class Take>
void forEachVector(const StripTarget& target, const PixelBox& box, StripSamples& samples, Take take) {
  const auto& [triangle, tables, block, bin_origin] = target;
  const int stride = block.lanes / block.pixels;
  // The largest entries of a group's blocks. Groups are aligned, so that they lie in the bin, and edge
  // functions stay in range.
  constexpr int kBlocks = kGroupSide * kGroupSide;
  std::array<std::array<std::int32_t, kBlocks>, 3> most;
  for (int i = 0; i < 3; ++i) {
    const std::int32_t step_x = tables.step_x[i] * block.pixels, step_y = tables.step_y[i];
    for (int k = 0; k < kBlocks; ++k)
      most[i][k] = tables.most[i] + step_x * (k % kGroupSide) + step_y * (k / kGroupSide);
  }
  const int first_x = box.first.x / block.pixels, last_x = box.last.x / block.pixels;
  for (int group_y = box.first.y / kGroupSide * kGroupSide; group_y <= box.last.y; group_y += kGroupSide) {
    const std::uint32_t rows = placesWithin(group_y, box.first.y, box.last.y, kGroupSide);
    for (int group_x = first_x / kGroupSide * kGroupSide; group_x <= last_x; group_x += kGroupSide) {
      std::array<std::int32_t, 3> start;
      for (int i = 0; i < 3; ++i)
        start[i] = tables.step_x[i] * (group_x * block.pixels) + tables.step_y[i] * group_y;
      std::uint32_t reached = 0;
      for (int k = 0; k < kBlocks; ++k)
        reached |=
            std::uint32_t(((start[0] + most[0][k]) | (start[1] + most[1][k]) | (start[2] + most[2][k])) >= 0)
            << k;
      const std::uint32_t columns = placesWithin(group_x, first_x, last_x, 1);
      for (reached &= rows & columns * 0x1111u; reached != 0; reached &= reached - 1) {
        const int k = std::countr_zero(reached);
        const int x = (group_x + k % kGroupSide) * block.pixels, y = group_y + k / kGroupSide;
        std::array<std::int32_t, 3> edges;
        for (int i = 0; i < 3; ++i) edges[i] = tables.step_x[i] * x + tables.step_y[i] * y;
        const float depth = float(triangle.depth + triangle.depth_dx * (bin_origin.x + x) +
                                  triangle.depth_dy * (bin_origin.y + y));
        const std::size_t first = (std::size_t(y - samples.first_row) * kBinSize + x) * std::size_t(stride);
        for (int lane = 0; lane < block.lanes; lane += kVector) {
          const Samples at{
              edges,
              {tables.edges[0].data() + lane, tables.edges[1].data() + lane, tables.edges[2].data() + lane},
              depth,
              tables.depth.data() + lane,
              triangle.depth_low,
              triangle.depth_high,
              samples.depth.data() + first + lane,
              samples.label.data() + first + lane};
          take(at, glm::ivec2(x, y), lane);
        }
      }
    }
  }
}

/// Both draw a triangle to a box of the bin's pixels, and return whether it covers a sample, visible or not.
bool drawOpaqueSamples(const StripTarget& target, const PixelBox& box, StripSamples& samples) {
  alignas(64) std::array<std::int32_t, kVector> covered{};
  forEachVector(target, box, samples, [&](const Samples& at, const glm::ivec2&, int) {
    takeOpaque(at, target.triangle.triangle, covered);
  });
  std::int32_t any = 0;
  for (int lane = 0; lane < kVector; ++lane) any |= covered[lane];
  return any != 0;
}

bool drawMaskedSamples(const StripTarget& target, const PixelBox& box, const HoleTest& holes,
                       const SamplePattern& pattern, StripSamples& samples) {
  const std::uint32_t number = target.triangle.triangle;
  std::optional<Surface> surface;
  bool covered = false;
  forEachVector(target, box, samples, [&](const Samples& at, const glm::ivec2& pixel, int first_lane) {
    covered |= takeMasked(at, number, [&](int lane_of_vector) {
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
  return covered;
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
    const bool covered = triangle.masked ? drawMaskedSamples(target, box, holes, pattern, samples)
                                         : drawOpaqueSamples(target, box, samples);
    // Several bins may write it at once.
    if (covered) std::atomic_ref(covering[triangle.triangle]).store(1, std::memory_order_relaxed);
  }
}

}  // namespace luciole
