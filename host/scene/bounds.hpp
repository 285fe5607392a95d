#pragma once

#include <glm/glm.hpp>

#include "luciole/scene.hpp"

namespace luciole {

/// Axis-aligned box, world space, metres. Empty: low > high.
struct Bounds {
  glm::dvec3 low{1e300};
  glm::dvec3 high{-1e300};
};

/// The bounding box of one object's vertices, and of those of all objects; empty without vertices.
/// O(vertices).
Bounds objectBounds(const Scene& scene, const Object& object);
Bounds sceneBounds(const Scene& scene);

}  // namespace luciole
