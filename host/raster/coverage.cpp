#include "raster/coverage.hpp"

#include <algorithm>
#include <atomic>
#include <bit>
#include <optional>

#include "raster/edge.hpp"

namespace luciole {
namespace {

/// The kind of labels: the visible triangle's number, or its slopes of depth.
enum class Label : std::uint8_t { kTriangle, kSlopes };

template <Label kLabel>
std::uint32_t labelOf(const RasterTriangle& triangle) {
  return kLabel == Label::kTriangle ? triangle.triangle
                                    : packSlopes(float(triangle.depth_dx), float(triangle.depth_dy));
}

constexpr int kLanes = 16;  ///< pixels of a row that are drawn together, as SIMD lanes

/// Three functions, each ≥ 0 at the samples on the inner side of an edge, those on the edge itself only where
/// it is a left or a top edge, so that triangles sharing the edge never both cover a sample (Pineda, "A
/// parallel algorithm for polygon rasterization", 1988).
///
/// E(x, y) = dx · (y − y_a) − dy · (x − x_a) in 1/256 pixel needs 46 bits. But from one sample to another it
/// changes by multiples of 256, so E ≥ 0 exactly if ⌊E / 256⌋ ≥ 0 there, and that changes by dx and dy. Both
/// are at most 2²³ inside the guard band, so within a bin of 64 pixels by less than 2³⁰; a value beyond ±2³⁰
/// at the bin's origin keeps its sign all over the bin and can as well be ±2³⁰. So 32 bits are enough, for a
/// triangle of any size.
struct EdgeFunctions {
  std::int32_t origin[3];  ///< at the bin's first sample
  std::int32_t step_x[3];
  std::int32_t step_y[3];
};

EdgeFunctions edgeFunctions(const RasterTriangle& triangle, glm::ivec2 bin_origin) {
  EdgeFunctions edges;
  for (int i = 0; i < 3; ++i) {
    const auto [dx, dy, value] = edgeOf(triangle, i, bin_origin);
    edges.origin[i] = std::int32_t(std::clamp(value >> kSubpixelBits, -kFarEdge, kFarEdge));
    edges.step_x[i] = -dy;
    edges.step_y[i] = dx;
  }
  return edges;
}

/// The pixels of a bin that one triangle is drawn to.
struct Target {
  const RasterTriangle& triangle;
  EdgeFunctions edges;
  glm::ivec2 bin_origin;

  /// The edge functions at the first pixel of a group.
  std::array<std::int32_t, 3> edgesAt(int x, int y) const {
    return {edges.origin[0] + edges.step_x[0] * x + edges.step_y[0] * y,
            edges.origin[1] + edges.step_x[1] * x + edges.step_y[1] * y,
            edges.origin[2] + edges.step_x[2] * x + edges.step_y[2] * y};
  }
  /// The depth there. The pixels of a group add float steps to it: at most 15, so few that float is exact
  /// enough.
  float depthAt(int x, int y) const {
    return float(triangle.depth + triangle.depth_dx * (bin_origin.x + x) +
                 triangle.depth_dy * (bin_origin.y + y));
  }
};

/// kLanes pixels of a row.
struct Group {
  int x, y;               ///< its first pixel, in the bin
  std::int32_t edges[3];  ///< the edge functions there
  float start;            ///< the triangle's depth there
  float* depth;           ///< of the pixels, as in BinPixels
  std::uint32_t* label;
};

constexpr int kRows = 16;     ///< tested together, as SIMD lanes
constexpr int kFewRows = 12;  ///< up to here drawing all rows costs less than testing which are covered

/// The rows, a bit each, of the kRows groups below (x, y) in which the triangle may cover a sample. The bits
/// set are contiguous, since each edge excludes rows at one end only.
std::uint32_t rowsReached(const Target& target, int x, int y) {
  const auto [e0, e1, e2] = target.edgesAt(x, y);
  const std::int32_t* step_x = target.edges.step_x;
  const std::int32_t* step_y = target.edges.step_y;
  std::int32_t reach[3];  // from a group's first pixel to where an edge function is largest
  for (int i = 0; i < 3; ++i) reach[i] = std::max(0, step_x[i] * (kLanes - 1));
  std::uint32_t rows = 0;
  for (int row = 0; row < kRows; ++row) {
    const std::int32_t reached = (e0 + reach[0] + step_y[0] * row) | (e1 + reach[1] + step_y[1] * row) |
                                 (e2 + reach[2] + step_y[2] * row);
    rows |= std::uint32_t(reached >= 0) << row;
  }
  return rows;
}

/// Calls `visit` with every group in a box of the bin's pixels in which the triangle may cover a sample.
template <class Visit>
void forEachGroup(const Target& target, const PixelBox& box, BinPixels& pixels, Visit visit) {
  const bool few = box.last.y - box.first.y < kFewRows;
  for (int y = box.first.y / kRows * kRows; y <= box.last.y; y += kRows) {
    for (int x = box.first.x / kLanes * kLanes; x <= box.last.x; x += kLanes) {
      const std::uint32_t rows = few ? (1u << kRows) - 1 : rowsReached(target, x, y);
      const int end = std::min(y + int(std::bit_width(rows)), box.last.y + 1);
      for (int in = std::max(y + std::countr_zero(rows), box.first.y); in < end; ++in) {
        const auto [e0, e1, e2] = target.edgesAt(x, in);
        const int first = in * kBinSize + x;
        visit(Group{x,
                    in,
                    {e0, e1, e2},
                    target.depthAt(x, in),
                    pixels.depth.data() + first,
                    pixels.label.data() + first});
      }
    }
  }
}

/// Whether a triangle covers any sample of a group.
bool coversAny(const Group& group, const std::int32_t* step_x) {
  const auto [e0, e1, e2] = group.edges;
  std::int32_t any = 0;
  for (int lane = 0; lane < kLanes; ++lane)
    any |= ((e0 + step_x[0] * lane) | (e1 + step_x[1] * lane) | (e2 + step_x[2] * lane)) >= 0;
  return any != 0;
}

/// Draws an opaque triangle to a box of the bin's pixels. Returns whether it covers a sample, visible or not;
/// for Label::kSlopes always false.
template <Label kLabel>
bool drawOpaque(const Target& target, const PixelBox& box, BinPixels& pixels) {
  const float step = float(target.triangle.depth_dx);
  const float low = target.triangle.depth_low;
  const float high = target.triangle.depth_high;
  const std::uint32_t own_label = labelOf<kLabel>(target.triangle);
  const std::int32_t* step_x = target.edges.step_x;
  bool covered = false;
  forEachGroup(target, box, pixels, [&](const Group& group) {
    const auto [e0, e1, e2] = group.edges;
    for (int lane = 0; lane < kLanes; ++lane) {
      const std::int32_t inside =
          ((e0 + step_x[0] * lane) | (e1 + step_x[1] * lane) | (e2 + step_x[2] * lane)) >= 0;
      const float z = std::min(std::max(group.start + step * float(lane), low), high);
      const bool seen = inside & std::int32_t(z > group.depth[lane]);
      group.depth[lane] = seen ? z : group.depth[lane];
      group.label[lane] = seen ? own_label : group.label[lane];
    }
    if (kLabel == Label::kTriangle && !covered) covered = coversAny(group, step_x);
  });
  return covered;
}

/// Samples at which a triangle is the nearest unless it has a hole there.
struct NearestSamples {
  int count = 0;
  Lanes<double> x{}, y{};  ///< pixels of the whole picture
  Lanes<int> place;        ///< in BinPixels
  Lanes<float> z;
};

/// Draws the samples where the triangle has no hole, and clears the list.
void drawWhereSolid(const HoleTest& holes, const Surface& surface, std::uint32_t label,
                    NearestSamples& samples, BinPixels& pixels) {
  LaneMask wanted;
  for (int i = 0; i < kSquarePixels; ++i) wanted[i] = i < samples.count;
  const LaneMask open =
      holesIn(holes.scene, surface, holes.plane, samples.x, samples.y, wanted, holes.sample);
  for (int i = 0; i < samples.count; ++i) {
    if (open[i]) continue;
    pixels.depth[samples.place[i]] = samples.z[i];
    pixels.label[samples.place[i]] = label;
  }
  samples.count = 0;
}

/// The same as drawOpaque() for a triangle with holes. Its opacity is looked up only at samples where it is
/// the nearest, of several groups together.
template <Label kLabel>
bool drawMasked(const Target& target, const PixelBox& box, const HoleTest& holes, BinPixels& pixels) {
  const float step = float(target.triangle.depth_dx);
  const float low = target.triangle.depth_low;
  const float high = target.triangle.depth_high;
  const std::uint32_t number = target.triangle.triangle;
  const std::uint32_t own_label = labelOf<kLabel>(target.triangle);
  const std::int32_t* step_x = target.edges.step_x;
  std::optional<Surface> surface;
  NearestSamples samples;
  const auto drawSamples = [&] {
    if (samples.count == 0) return;
    if (!surface) surface = makeSurface(holes.scene, holes.objects, number, holes.plane);
    drawWhereSolid(holes, *surface, own_label, samples, pixels);
  };
  std::int32_t covered = 0;
  forEachGroup(target, box, pixels, [&](const Group& group) {
    const auto [e0, e1, e2] = group.edges;
    std::array<float, kLanes> z;
    std::uint32_t nearest = 0;  // a bit a lane
    for (int lane = 0; lane < kLanes; ++lane) {
      const std::int32_t inside =
          ((e0 + step_x[0] * lane) | (e1 + step_x[1] * lane) | (e2 + step_x[2] * lane)) >= 0;
      z[lane] = std::min(std::max(group.start + step * float(lane), low), high);
      covered |= inside;
      std::int32_t nearer = z[lane] > group.depth[lane];
      // Opaque triangles are drawn first, out of order, so at equal depth the lower number must win here. A
      // depth of 0 is nothing.
      if (kLabel == Label::kTriangle)
        nearer |= (z[lane] == group.depth[lane]) & (number < group.label[lane]) & (z[lane] > 0.0f);
      nearest |= std::uint32_t(inside & nearer) << lane;
    }
    for (; nearest != 0; nearest &= nearest - 1) {
      const int lane = std::countr_zero(nearest), i = samples.count++;
      samples.x[i] = target.bin_origin.x + group.x + lane;
      samples.y[i] = target.bin_origin.y + group.y;
      samples.place[i] = group.y * kBinSize + group.x + lane;
      samples.z[i] = z[lane];
      if (samples.count == kSquarePixels) drawSamples();
    }
  });
  drawSamples();
  return covered != 0;
}

template <Label kLabel>
void draw(std::span<const RasterTriangle> triangles, const Bins& bins, int bin, const HoleTest& holes,
          std::span<std::uint8_t> covering, BinPixels& pixels) {
  pixels.depth.fill(0.0f);
  pixels.label.fill(kLabel == Label::kTriangle ? kNoTriangle : 0);
  const glm::ivec2 origin = bins.origin(bin);
  const std::span<const std::uint32_t> list = bins.list(bin);
  for (std::size_t i = 0; i < list.size(); ++i) {
    // Far enough ahead to hide the latency of memory.
    if (i + 8 < list.size()) __builtin_prefetch(&triangles[list[i + 8]]);
    const RasterTriangle& triangle = triangles[list[i]];
    const PixelBox whole = pixelBox(triangle, glm::ivec2(0));
    const PixelBox box{glm::max(whole.first - origin, glm::ivec2(0)),
                       glm::min(whole.last - origin, glm::ivec2(kBinSize - 1))};
    const Target target{triangle, edgeFunctions(triangle, origin), origin};
    const bool covered = triangle.masked ? drawMasked<kLabel>(target, box, holes, pixels)
                                         : drawOpaque<kLabel>(target, box, pixels);
    // Several bins may write it at once.
    if (kLabel == Label::kTriangle && covered)
      std::atomic_ref(covering[triangle.triangle]).store(1, std::memory_order_relaxed);
  }
}

}  // namespace

std::uint32_t packSlopes(float dx, float dy) {
  // Adding half of the part cut off rounds to nearest. Steps are below 10³⁰, so nothing overflows.
  const std::uint32_t high = std::bit_cast<std::uint32_t>(dx) + 0x8000u;
  const std::uint32_t low = std::bit_cast<std::uint32_t>(dy) + 0x8000u;
  return (high & 0xffff0000u) | low >> 16;
}

void drawBin(std::span<const RasterTriangle> triangles, const Bins& bins, int bin, const HoleTest& holes,
             std::span<std::uint8_t> covering, BinPixels& pixels) {
  draw<Label::kTriangle>(triangles, bins, bin, holes, covering, pixels);
}

void drawBinDepth(std::span<const RasterTriangle> triangles, const Bins& bins, int bin, const HoleTest& holes,
                  BinPixels& pixels) {
  draw<Label::kSlopes>(triangles, bins, bin, holes, {}, pixels);
}

}  // namespace luciole
