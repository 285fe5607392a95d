#include "raster/bound_bin.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "raster/bound_depth.hpp"

namespace luciole {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// Half the side of a texel's grown square. 2⁻²⁴ texels more than BoundTexel needs, which covers the rounding
/// of cut corners below (2⁻³⁶ texels).
constexpr double kHalf = 0.5 + kBoundGrowth + 0x1p-24;

/// The part of a polygon with sign · (p[axis] − limit) ≤ 0. New corners lie on the limit, and their depths
/// between those of their edge.
template <int kAxis, int kSign>
void cut(const TexelPolygon& polygon, double limit, TexelPolygon& kept) {
  clipPolygon(
      polygon, [limit](const glm::dvec3& p) { return kSign * (limit - p[kAxis]); },
      [limit](const glm::dvec3& a, double da, const glm::dvec3& b, double db) {
        glm::dvec3 p = edgeCrossing(a, da, b, db);
        p[kAxis] = limit;
        return p;
      },
      kept);
}

/// The texels of a bin, along one axis, whose grown squares an interval of places touches. Places are clamped
/// to the bin as doubles, since they may be far outside the range of an int.
struct Range {
  int first, last;
};
Range texelsTouched(double low, double high, int origin) {
  const double from = std::clamp(std::ceil(low - kHalf) - origin, 0.0, double(kBinSize));
  const double to = std::clamp(std::floor(high + kHalf) - origin, -1.0, double(kBinSize - 1));
  return {int(from), int(to)};
}

double planeMargin(const BoundTexel& texel) {
  return 2.0 * kPlaneError *
         (std::abs(double(texel.depth)) + std::abs(double(texel.step_x)) + std::abs(double(texel.step_y)));
}

/// Whether a polygon inside a texel's grown square may be nearer than the texel's plane anywhere. (x, y) is
/// the texel's centre.
bool mayBeInFront(const TexelPolygon& polygon, const BoundPiece& piece, const BoundTexel& texel, double x,
                  double y) {
  const double margin = planeMargin(texel) + piece.depth_error +
                        piece.place_error * (std::abs(double(texel.step_x)) + std::abs(double(texel.step_y)));
  for (int i = 0; i < polygon.count; ++i) {
    const glm::dvec3& p = polygon.corners[i];
    if (!(p.z + margin < texel.depth + texel.step_x * (p.x - x) + texel.step_y * (p.y - y))) return true;
  }
  return false;
}

}  // namespace

void clearBin(const glm::ivec2& origin, bool unknown, BoundBin& bin) {
  bin.origin = origin;
  bin.texels.fill({-kInfinity, 0, 0, unknown ? kInfinity : 0.0f});
  bin.covering.fill(nullptr);
  bin.lowest.fill(-std::numeric_limits<double>::infinity());
}

void drawPlane(const BoundPiece& piece, BoundBin& bin) {
  struct Edge {
    double x, y, dx, dy, reach;
  };
  std::array<Edge, 7> edges;
  for (int i = 0; i < piece.count; ++i) {
    const glm::dvec3 &a = piece.corners[i], &b = piece.corners[i + 1 == piece.count ? 0 : i + 1];
    edges[i] = {a.x, a.y, b.x - a.x, b.y - a.y, kHalf * (std::abs(b.x - a.x) + std::abs(b.y - a.y))};
  }
  const Range rows = texelsTouched(piece.low.y + 1, piece.high.y - 1, bin.origin.y);
  const Range columns = texelsTouched(piece.low.x + 1, piece.high.x - 1, bin.origin.x);
  const glm::dvec3& base = piece.corners[piece.base];
  const BoundTexel steps{0, float(piece.step_x), float(piece.step_y), 0};
  const double drop = kHalf * (std::abs(piece.step_x) + std::abs(piece.step_y));
  for (int row = rows.first; row <= rows.last; ++row) {
    const double y = row + bin.origin.y;
    for (int column = columns.first; column <= columns.last; ++column) {
      const double x = column + bin.origin.x;
      bool covers = true;
      for (int i = 0; i < piece.count; ++i) {
        const Edge& edge = edges[i];
        covers &= edge.dx * (y - edge.y) - edge.dy * (x - edge.x) >= edge.reach;
      }
      if (!covers) continue;
      const double depth = piece.depth + piece.step_x * (x - base.x) + piece.step_y * (y - base.y);
      // Close to the far plane the error is too large for the depth, and behind the near plane nothing is
      // drawn: there covering isn't certain.
      if (!(3 * piece.depth_error <= 0x1p-24 * depth && depth + drop <= 1.0)) continue;
      const int at = row * kBinSize + column;
      BoundTexel texel = steps;
      texel.depth = float(depth);
      if (!std::isfinite(texel.step_x) || !std::isfinite(texel.step_y)) continue;
      const double lowest = depth - drop - planeMargin(texel);
      if (!(lowest > bin.lowest[at])) continue;
      bin.texels[at] = texel;
      bin.covering[at] = &piece;
      bin.lowest[at] = lowest;
    }
  }
}

void drawOther(const BoundPiece& piece, BoundBin& bin) {
  const Range rows = texelsTouched(piece.low.y, piece.high.y, bin.origin.y);
  // Whether a piece whose nearest depth is `highest` may change a texel's bounds.
  const auto matters = [&](int at, double highest) {
    return highest > bin.texels[at].others && highest >= bin.lowest[at] && bin.covering[at] != &piece;
  };
  const auto anyMatters = [&](int row, const Range& columns, double highest) {
    bool any = false;
    for (int column = columns.first; column <= columns.last; ++column)
      any |= matters(row * kBinSize + column, highest);
    return any;
  };
  const Range box = texelsTouched(piece.low.x, piece.high.x, bin.origin.x);
  auto& [whole, scratch, strip, part] = bin.polygons;
  whole.count = piece.count;
  std::copy_n(piece.corners.begin(), piece.count, whole.corners.begin());
  for (int row = rows.first; row <= rows.last; ++row) {
    if (!anyMatters(row, box, piece.high.z + piece.depth_error)) continue;
    const double y = row + bin.origin.y;
    cut<1, -1>(whole, y - kHalf, scratch);
    if (scratch.count == 0) continue;
    cut<1, 1>(scratch, y + kHalf, strip);
    if (strip.count == 0) continue;
    glm::dvec3 low = strip.corners[0], high = low;
    for (int i = 1; i < strip.count; ++i) {
      low = glm::min(low, strip.corners[i]);
      high = glm::max(high, strip.corners[i]);
    }
    const Range columns = texelsTouched(low.x, high.x, bin.origin.x);
    for (int column = columns.first; column <= columns.last; ++column) {
      const int at = row * kBinSize + column;
      if (!matters(at, high.z + piece.depth_error)) continue;
      const double x = column + bin.origin.x;
      cut<0, -1>(strip, x - kHalf, scratch);
      if (scratch.count == 0) continue;
      cut<0, 1>(scratch, x + kHalf, part);
      if (part.count == 0) continue;
      BoundTexel& texel = bin.texels[at];
      if (bin.covering[at] && !mayBeInFront(part, piece, texel, x, y)) continue;
      double depth = part.corners[0].z;
      for (int i = 1; i < part.count; ++i) depth = std::max(depth, part.corners[i].z);
      depth += piece.depth_error;
      texel.others = depth > 1.0 ? kInfinity : std::max(texel.others, roundUp(depth));
    }
  }
}

float roundUp(double value) {
  const float rounded = float(value);
  return rounded < value ? std::nextafter(rounded, kInfinity) : rounded;
}

}  // namespace luciole
