#pragma once

#include <array>
#include <glm/glm.hpp>
#include <vector>

namespace luciole {

/// Triangulates a simple, nearly planar polygon of n ≥ 3 corners, convex or not, into n − 2 triangles of
/// corner indices by ear clipping (Meisters, "Polygons have ears", 1975). Triangles have the polygon's
/// winding. A convex polygon becomes the fan around corner 0. A hole may be joined to the outline by a
/// bridge, whose corners repeat. Repeated and collinear corners are fine, also with the rounding of floats. A
/// polygon that crosses itself or has no area still gives n − 2 triangles, some of them wrong. O(n) for a
/// convex polygon; O(n log n) for most; never more than O(n √n) tests of a point in a triangle.
std::vector<std::array<int, 3>> triangulate(const std::vector<glm::dvec3>& polygon);

}  // namespace luciole
