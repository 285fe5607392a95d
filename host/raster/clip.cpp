#include "raster/clip.hpp"

#include <algorithm>
#include <utility>

namespace luciole {
namespace {

enum Side { kNear, kFar, kLeft, kRight, kBottom, kTop, kSides };

/// Signed distance in clip space, not normalized; ≥ 0 inside.
double distance(const glm::dvec4& p, Side side, const ClipVolume& volume) {
  switch (side) {
    case kNear:
      return p.w - p.z;
    case kFar:
      return p.z;
    case kLeft:
      return volume.guard.x * p.w + p.x;
    case kRight:
      return volume.guard.x * p.w - p.x;
    case kBottom:
      return volume.guard.y * p.w + p.y;
    default:
      return volume.guard.y * p.w - p.y;
  }
}

/// The new corner of a cut edge, in the clip plane. Always computed from the corner inside to the one
/// outside, so that both triangles of an edge get the same bits.
glm::dvec4 crossing(const glm::dvec4& a, double da, const glm::dvec4& b, double db, Side side,
                    const ClipVolume& volume) {
  glm::dvec4 p = da >= 0.0 ? edgeCrossing(a, da, b, db) : edgeCrossing(b, db, a, da);
  // Rounding may put the new corner beside the plane, or, where lengths differ by a factor of 10¹⁶, behind
  // the eye.
  p.w = std::max(p.w, volume.near_w);
  if (side == kNear) p.z = p.w = volume.near_w;
  if (side == kFar) p.z = 0.0;
  if (side == kLeft) p.x = -volume.guard.x * p.w;
  if (side == kRight) p.x = volume.guard.x * p.w;
  if (side == kBottom) p.y = -volume.guard.y * p.w;
  if (side == kTop) p.y = volume.guard.y * p.w;
  return p;
}

}  // namespace

ClipVolume clipVolume(const View& view) {
  const Camera camera = viewCamera(view);
  return {2.0 * kGuardPixels / glm::dvec2(view.size), camera.orthographic ? 1.0 : camera.near};
}

ClipPolygon clipTriangle(const std::array<glm::dvec4, 3>& triangle, const ClipVolume& volume) {
  // clipPolygon puts a new corner on the last edge first. So the corners are clipped in reverse order: then
  // the first corner stays at the end, which becomes the front.
  ClipPolygon polygon{{triangle[2], triangle[1], triangle[0]}, 3}, kept;
  for (int i = 0; i < kSides; ++i) {
    const Side side = Side(i);
    clipPolygon(
        polygon, [&](const glm::dvec4& p) { return distance(p, side, volume); },
        [&](const glm::dvec4& a, double da, const glm::dvec4& b, double db) {
          return crossing(a, da, b, db, side, volume);
        },
        kept);
    std::swap(polygon, kept);
  }
  std::reverse(polygon.corners.begin(), polygon.corners.begin() + polygon.count);
  return polygon;
}

}  // namespace luciole
