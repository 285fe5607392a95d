#pragma once

#include <cstdint>

#include "luciole/scene.hpp"

namespace luciole {

/// The number of triangles of all objects: those of a mesh count once for each object that shows it.
inline std::uint64_t countTriangles(const Scene& scene) {
  std::uint64_t count = 0;
  for (const Object& object : scene.objects) count += scene.meshes[object.mesh].triangles.size();
  return count;
}

}  // namespace luciole
