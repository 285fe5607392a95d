#pragma once

#include <array>
#include <glm/glm.hpp>

#include "base/picture_size.hpp"
#include "raster/clip_polygon.hpp"
#include "raster/view.hpp"

namespace luciole {

/// How far from the picture's centre a triangle may reach before it is cut, in pixels: as far as the largest
/// picture does. It keeps the edge functions within 32 bits (see coverage.cpp).
constexpr int kGuardPixels = kLargestSide / 2;

/// The part of clip space that is drawn: 0 ≤ z ≤ w, |x| ≤ guard.x · w, |y| ≤ guard.y · w.
struct ClipVolume {
  glm::dvec2 guard;
  double near_w;  ///< w on the near plane, > 0
};
ClipVolume clipVolume(const View& view);

/// After six planes a triangle has at most 3, 4, 6, 9, 13, 19, 28 corners.
using ClipPolygon = Polygon<glm::dvec4, 28>;

/// What is left of a triangle in the volume, in the triangle's winding; its first corner comes first if it is
/// left. Triangles that share an edge get the same new corners on it,
/// bit for bit.
ClipPolygon clipTriangle(const std::array<glm::dvec4, 3>& triangle, const ClipVolume& volume);

}  // namespace luciole
