#pragma once

#include "luciole/scene.hpp"

namespace luciole {

/// Finds triangles too large for Gouraud shading, which lights their corners only and loses lights that shine
/// between them. Returns the width (the longest edge, metres) of the widest triangle of the meshes' divided
/// forms if it is larger than the least range of a light with a position, or than a quarter of the scene's
/// diagonal. Otherwise, and if no light has a position, returns 0. O(triangles).
double coarseTriangleWidth(const Scene& scene);

}  // namespace luciole
