#include "scene/bounds.hpp"

namespace luciole {

Bounds objectBounds(const Scene& scene, const Object& object) {
  Bounds bounds;
  for (const glm::vec3& position : scene.meshes[object.mesh].positions) {
    const glm::dvec3 place = object.object_to_world * glm::dvec4(position, 1);
    bounds.low = glm::min(bounds.low, place);
    bounds.high = glm::max(bounds.high, place);
  }
  return bounds;
}

Bounds sceneBounds(const Scene& scene) {
  Bounds bounds;
  for (const Object& object : scene.objects) {
    const Bounds one = objectBounds(scene, object);
    bounds.low = glm::min(bounds.low, one.low);
    bounds.high = glm::max(bounds.high, one.high);
  }
  return bounds;
}

}  // namespace luciole
