#pragma once

#include <array>
#include <glm/glm.hpp>

#include "base/picture_size.hpp"
#include "raster/clip_polygon.hpp"
#include "raster/view.hpp"

namespace luciole {

/// The guard band: how far from the picture's centre, in pixels, a triangle may reach before it is clipped at
/// the sides. As far as the largest picture's border, so that edge functions fit 32 bits (see coverage.cpp).
constexpr int kGuardPixels = kLargestSide / 2;

/// The part of clip space that triangles are clipped to: 0 ≤ z ≤ w, |x| ≤ guard.x · w, |y| ≤ guard.y · w.
struct ClipVolume {
  glm::dvec2 guard;
  double near_w;  ///< w on the near plane, > 0
};
/// The clip volume of a view: its depth range, and the guard band around its picture.
ClipVolume clipVolume(const View& view);

/// After six planes a triangle has at most 3, 4, 6, 9, 13, 19, 28 corners.
using ClipPolygon = Polygon<glm::dvec4, 28>;

/// Clips a triangle, in clip space, to the volume. The polygon keeps the triangle's winding, and begins with
/// its first corner unless that is clipped away; it is empty where the triangle lies outside. Triangles that
/// share an edge get the same new corners on it, bit for bit.
ClipPolygon clipTriangle(const std::array<glm::dvec4, 3>& triangle, const ClipVolume& volume);

}  // namespace luciole
