#pragma once

#include <cstddef>

#include "luciole/scene.hpp"

namespace luciole {

/// Throws the InputError of validateScene() if a triangle of a mesh refers to a vertex that there isn't.
/// `mesh` indexes Scene::meshes. O(triangles).
void checkTriangles(const Scene& scene, std::size_t mesh);

}  // namespace luciole
