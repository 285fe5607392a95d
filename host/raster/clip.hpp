#pragma once

#include <array>
#include <glm/glm.hpp>

#include "base/picture_size.hpp"
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

/// In the triangle's winding. Cutting a convex polygon adds one corner a plane, but rounding may dent it, and
/// of n corners in any order a plane makes 3n/2 at most: 3, 4, 6, 9, 13, 19, 28 after six planes.
struct ClipPolygon {
  std::array<glm::dvec4, 28> corners;
  int count = 0;
};

/// What is left of a triangle in the volume. Triangles that share an edge get the same new corners on it, bit
/// for bit.
ClipPolygon clipTriangle(const std::array<glm::dvec4, 3>& triangle, const ClipVolume& volume);

}  // namespace luciole
