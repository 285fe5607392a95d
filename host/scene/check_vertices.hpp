#pragma once

#include <cstddef>

#include "luciole/scene.hpp"

namespace luciole {

/// Throws the InputError of validateScene() where a mesh without normals has other arrays of vertices that
/// don't fit, or a triangle refers to a vertex that there isn't. `mesh` indexes Scene::meshes. O(vertices +
/// triangles).
void checkVertices(const Scene& scene, std::size_t mesh);

}  // namespace luciole
