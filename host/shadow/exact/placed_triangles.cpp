#include "shadow/exact/placed_triangles.hpp"

#include <algorithm>
#include <cmath>

namespace luciole {

PlacedTriangles placeTriangles(const Scene& scene, const glm::dvec3& origin, double scale) {
  PlacedTriangles placed{scene, origin, scale, {0}};
  for (const Object& object : scene.objects)
    placed.first.push_back(placed.first.back() + std::uint32_t(scene.meshes[object.mesh].triangles.size()));
  return placed;
}

std::uint32_t objectOf(const PlacedTriangles& placed, std::uint32_t triangle) {
  return std::uint32_t(std::upper_bound(placed.first.begin(), placed.first.end(), triangle) -
                       placed.first.begin() - 1);
}

std::array<glm::dvec3, 3> cornersOf(const PlacedTriangles& placed, std::uint32_t object,
                                    std::uint32_t triangle) {
  const Object& placing = placed.scene.objects[object];
  const Mesh& mesh = placed.scene.meshes[placing.mesh];
  const glm::uvec3& indices = mesh.triangles[triangle - placed.first[object]];
  std::array<glm::dvec3, 3> corners;
  bool inside = true;
  for (int i = 0; i < 3; ++i) {
    corners[i] =
        (glm::dvec3(placing.object_to_world * glm::dvec4(mesh.positions[indices[i]], 1)) - placed.origin) *
        placed.scale;
    for (int axis = 0; axis < 3; ++axis) inside &= std::abs(corners[i][axis]) <= kLargestPlaced;
  }
  return inside ? corners : std::array<glm::dvec3, 3>{};
}

std::uint32_t materialOfTriangle(const PlacedTriangles& placed, std::uint32_t object,
                                 std::uint32_t triangle) {
  const Object& placing = placed.scene.objects[object];
  return placing.material >= 0
             ? std::uint32_t(placing.material)
             : placed.scene.meshes[placing.mesh].triangle_materials[triangle - placed.first[object]];
}

bool hasHoles(const PlacedTriangles& placed, std::uint32_t object, std::uint32_t triangle) {
  return placed.scene.materials[materialOfTriangle(placed, object, triangle)].alpha_cutoff > 0;
}

}  // namespace luciole
