#pragma once

#include <array>
#include <glm/glm.hpp>
#include <vector>

namespace luciole {

/// Cuts a simple polygon of n ≥ 3 corners, convex or not and nearly plane, into n − 2 triangles of corner
/// numbers wound as the polygon is. A convex polygon becomes the fan around corner 0. A polygon that crosses
/// itself or has no area still gives n − 2 triangles, some of them wrong.
std::vector<std::array<int, 3>> triangulate(const std::vector<glm::dvec3>& polygon);

}  // namespace luciole
