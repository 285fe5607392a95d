#pragma once

#include "scene/scene.hpp"

namespace luciole {

/// Gouraud shading lights the corners of triangles only, so a light that shines between them is lost. Returns
/// the width (the longest edge, metres) of the widest triangle that loses a light so; 0 if there is none. A
/// triangle loses a light if a point light stands over it, or a spot's axis meets it, and the place below the
/// light, or on the axis, gets more than four times the light of every corner.
///
/// Looks at the 1024 largest triangles (of meshes as they are divided for Gouraud shading) and at up to 1024
/// evenly chosen lights. So a larger scene takes longer only to find the largest triangles, O(n log 1024).
/// Doesn't look for shadows between corners.
double coarseTriangleWidth(const Scene& scene);

}  // namespace luciole
