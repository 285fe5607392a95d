#pragma once

#include <array>
#include <glm/glm.hpp>
#include <vector>

namespace luciole {

/// Cuts a simple, nearly planar polygon of n ≥ 3 corners, convex or not, into n − 2 triangles of corner
/// numbers, by cutting off ears (Meisters, "Polygons have ears", 1975). Triangles have the polygon's winding.
/// A convex polygon becomes the fan around corner 0. Of a hole that a bridge joins to the outline, corners
/// repeat. Corners that stand twice or in line with others, but for the rounding of floats, are covered once,
/// too. A polygon that crosses itself or has no area still gives n − 2 triangles, some of them wrong. O(n)
/// for a convex polygon; O(n log n) for most; never more than O(n √n) tests of a point in a triangle.
std::vector<std::array<int, 3>> triangulate(const std::vector<glm::dvec3>& polygon);

}  // namespace luciole
