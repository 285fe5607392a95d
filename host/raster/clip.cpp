#include "raster/clip.hpp"

#include <algorithm>

namespace luciole {
namespace {

enum Side { kNear, kFar, kLeft, kRight, kBottom, kTop, kSides };

/// ≥ 0 inside.
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

/// Always computed from the inside out, so that it does not depend on the way round a triangle goes.
glm::dvec4 crossing(const glm::dvec4& inside, double inside_distance, const glm::dvec4& outside,
                    double outside_distance, Side side, const ClipVolume& volume) {
  const double t = inside_distance / (inside_distance - outside_distance);
  glm::dvec4 p = inside + t * (outside - inside);
  // Rounding may put the new corner beside the plane, or, where lengths differ by 10¹⁶, behind the eye.
  p.w = std::max(p.w, volume.near_w);
  if (side == kNear) p.z = p.w = volume.near_w;
  if (side == kFar) p.z = 0.0;
  if (side == kLeft) p.x = -volume.guard.x * p.w;
  if (side == kRight) p.x = volume.guard.x * p.w;
  if (side == kBottom) p.y = -volume.guard.y * p.w;
  if (side == kTop) p.y = volume.guard.y * p.w;
  return p;
}

/// One step of Sutherland and Hodgman, "Reentrant polygon clipping", 1974.
ClipPolygon clipAgainst(const ClipPolygon& polygon, Side side, const ClipVolume& volume) {
  ClipPolygon result;
  for (int i = 0; i < polygon.count; ++i) {
    const glm::dvec4& a = polygon.corners[i];
    const glm::dvec4& b = polygon.corners[(i + 1) % polygon.count];
    const double a_distance = distance(a, side, volume);
    const double b_distance = distance(b, side, volume);
    if (a_distance >= 0.0) result.corners[result.count++] = a;
    if (a_distance >= 0.0 && b_distance < 0.0)
      result.corners[result.count++] = crossing(a, a_distance, b, b_distance, side, volume);
    if (a_distance < 0.0 && b_distance >= 0.0)
      result.corners[result.count++] = crossing(b, b_distance, a, a_distance, side, volume);
  }
  return result;
}

}  // namespace

ClipVolume clipVolume(const View& view) {
  const Camera camera = viewCamera(view);
  return {2.0 * kGuardPixels / glm::dvec2(view.size), camera.orthographic ? 1.0 : camera.near};
}

ClipPolygon clipTriangle(const std::array<glm::dvec4, 3>& triangle, const ClipVolume& volume) {
  ClipPolygon polygon;
  std::copy(triangle.begin(), triangle.end(), polygon.corners.begin());
  polygon.count = 3;
  for (int side = 0; side < kSides; ++side) polygon = clipAgainst(polygon, Side(side), volume);
  return polygon;
}

}  // namespace luciole
