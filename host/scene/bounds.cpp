#include "scene/bounds.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

namespace luciole {
namespace {

Bounds join(const Bounds& a, const Bounds& b) { return {glm::min(a.low, b.low), glm::max(a.high, b.high)}; }

}  // namespace

Bounds objectBounds(const Scene& scene, const Object& object) {
  const std::vector<glm::vec3>& positions = scene.meshes[object.mesh].positions;
  const auto add = [&](const tbb::blocked_range<std::size_t>& range, Bounds bounds) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      const glm::dvec3 place(object.object_to_world * glm::dvec4(positions[i], 1));
      bounds = join(bounds, {place, place});
    }
    return bounds;
  };
  return tbb::parallel_reduce(tbb::blocked_range<std::size_t>(0, positions.size(), 8192), Bounds{}, add,
                              join);
}

Bounds sceneBounds(const Scene& scene) {
  const auto add = [&](const tbb::blocked_range<std::size_t>& range, Bounds bounds) {
    for (std::size_t i = range.begin(); i < range.end(); ++i)
      bounds = join(bounds, objectBounds(scene, scene.objects[i]));
    return bounds;
  };
  return tbb::parallel_reduce(tbb::blocked_range<std::size_t>(0, scene.objects.size()), Bounds{}, add, join);
}

}  // namespace luciole
