#pragma once

#include "scene/scene.hpp"

namespace luciole {

/// Gouraud shading lights the corners of triangles, and shows nothing of a light that shines between them. Of
/// the scene's largest triangles that this happens to: how wide the widest is, its longest edge in metres; 0
/// where it happens to none. It happens where a point light stands over a triangle, or a spot's axis meets
/// it, and that place gets more than four times the light of every corner.
///
/// Looks at up to 1024 triangles (of meshes' divided forms), the largest, and at as many lights, evenly
/// chosen: beyond finding the largest it takes no longer for a larger scene. Shadows between corners go
/// unseen.
double coarseTriangleWidth(const Scene& scene);

}  // namespace luciole
