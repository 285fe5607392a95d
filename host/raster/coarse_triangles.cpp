#include "raster/coarse_triangles.hpp"

#include <algorithm>
#include <cmath>

#include "raster/geometry.hpp"
#include "scene/bounds.hpp"

namespace luciole {
namespace {

constexpr double kLargePart = 0.25;  ///< of the scene's diagonal

double widestTriangle(const Scene& scene) {
  double squared = 0;
  for (const PlacedObject& object : placeObjects(scene, allObjects(scene), glm::dmat4(1), true))
    for (const glm::uvec3& triangle : object.mesh->triangles) {
      const auto edge = [&](int from, int to) {
        const glm::vec3 &a = object.mesh->positions[triangle[from]],
                        &b = object.mesh->positions[triangle[to]];
        const glm::dvec3 edge_in_view(object.object_to_view * glm::dvec4(glm::dvec3(b) - glm::dvec3(a), 0));
        return glm::dot(edge_in_view, edge_in_view);
      };
      squared = std::max({squared, edge(0, 1), edge(1, 2), edge(2, 0)});
    }
  return std::sqrt(squared);
}

}  // namespace

double coarseTriangleWidth(const Scene& scene) {
  const Bounds bounds = sceneBounds(scene);
  double most = kLargePart * glm::length(bounds.high - bounds.low);
  bool any_placed = false;
  for (const Light& light : scene.lights) {
    if (light.kind == LightKind::kDirectional) continue;
    any_placed = true;
    most = std::min(most, double(light.range));
  }
  if (!scene.lighting || !any_placed) return 0;
  const double width = widestTriangle(scene);
  return width > most ? width : 0;
}

}  // namespace luciole
