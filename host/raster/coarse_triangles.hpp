#pragma once

#include "luciole/scene.hpp"

namespace luciole {

/// Gouraud shading lights the corners of triangles only, so a light that shines between them is lost. Returns
/// the width (the longest edge, metres) of the scene's widest triangle, of meshes as they are divided for
/// that shading, where it is larger than the least range of a light with a place, or than a quarter of the
/// scene's diagonal; 0 where it isn't, or no light has a place. O(triangles).
double coarseTriangleWidth(const Scene& scene);

}  // namespace luciole
