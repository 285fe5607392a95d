#include "raster/lift.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace luciole {

Lift makeLift(const glm::bvec3& bent, const std::array<glm::dvec3, 3>& normals, const glm::dvec3& edge1,
              const glm::dvec3& edge2) {
  Lift lift;
  // Side i leads from corner i to the next one.
  const std::array<glm::dvec3, 3> to_next{edge1, edge2 - edge1, -edge2};
  double longest2 = 0.0;
  for (int i = 0; i < 3; ++i) {
    longest2 = std::max(longest2, glm::dot(to_next[i], to_next[i]));
    if (!bent[i]) continue;
    lift.rise[i][0] = -glm::dot(to_next[i], normals[i]);
    lift.rise[i][1] = glm::dot(to_next[(i + 2) % 3], normals[i]);
    lift.any |= lift.rise[i][0] > 0.0 || lift.rise[i][1] > 0.0;
  }
  lift.most = 0.5 * std::sqrt(longest2);
  return lift;
}

glm::bvec3 bentCorners(const Mesh& mesh, const glm::uvec3& corners) {
  const glm::dvec3 a(mesh.positions[corners[0]]);
  const glm::dvec3 own =
      glm::cross(glm::dvec3(mesh.positions[corners[1]]) - a, glm::dvec3(mesh.positions[corners[2]]) - a);
  glm::bvec3 bent(false);
  for (int i = 0; i < 3; ++i) {
    const glm::dvec3 normal(mesh.normals[corners[i]]);
    const double along = glm::dot(normal, own), across = glm::length(glm::cross(normal, own));
    bent[i] = along > 0.0 && across > kFlatAngle * along;
  }
  return bent;
}

bool hasBentCorners(const Scene& scene) {
  return std::any_of(scene.meshes.begin(), scene.meshes.end(), [](const Mesh& mesh) {
    return tbb::parallel_reduce(
        tbb::blocked_range<std::size_t>(0, mesh.triangles.size(), 4096), false,
        [&](const tbb::blocked_range<std::size_t>& range, bool found) {
          return found ||
                 std::any_of(mesh.triangles.begin() + std::ptrdiff_t(range.begin()),
                             mesh.triangles.begin() + std::ptrdiff_t(range.end()),
                             [&](const glm::uvec3& corners) { return glm::any(bentCorners(mesh, corners)); });
        },
        std::logical_or<bool>());
  });
}

}  // namespace luciole
