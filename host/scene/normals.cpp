#include "scene/normals.hpp"

#include <cmath>
#include <cstddef>

#include "luciole/scene.hpp"
#include "scene/check_triangles.hpp"

namespace luciole {
namespace {

/// Unit normal of a counter-clockwise triangle; 0 where it has no area.
glm::dvec3 faceNormal(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  const glm::dvec3 normal = glm::cross(b - a, c - a);
  const double length = glm::length(normal);
  return length > 0 ? normal / length : glm::dvec3(0);
}

/// The angle between two edges, radians. By atan2, because acos is inexact near 0 and π.
double angleBetween(const glm::dvec3& u, const glm::dvec3& v) {
  return std::atan2(glm::length(glm::cross(u, v)), glm::dot(u, v));
}

}  // namespace

std::vector<glm::vec3> angleWeightedNormals(const std::vector<glm::vec3>& positions,
                                            const std::vector<glm::uvec3>& triangles) {
  std::vector<glm::dvec3> sums(positions.size(), glm::dvec3(0));
  std::vector<glm::dvec3> any(positions.size(), glm::dvec3(0, 0, 1));
  for (const glm::uvec3& triangle : triangles) {
    const glm::dvec3 corners[3] = {positions[triangle.x], positions[triangle.y], positions[triangle.z]};
    const glm::dvec3 normal = faceNormal(corners[0], corners[1], corners[2]);
    if (normal == glm::dvec3(0)) continue;
    for (int i = 0; i < 3; ++i) {
      const glm::dvec3 next = corners[(i + 1) % 3] - corners[i];
      const glm::dvec3 previous = corners[(i + 2) % 3] - corners[i];
      sums[triangle[i]] += normal * angleBetween(next, previous);
      any[triangle[i]] = normal;
    }
  }
  // A sum this small is the rounding error of faces that cancel; its direction is arbitrary.
  constexpr double kVanished = 1e-9;
  std::vector<glm::vec3> normals(positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const double length = glm::length(sums[i]);
    normals[i] = glm::vec3(length > kVanished ? sums[i] / length : any[i]);
  }
  return normals;
}

void addNormals(Scene& scene) {
  for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
    Mesh& mesh = scene.meshes[i];
    if (!mesh.normals.empty()) continue;
    checkTriangles(scene, i);
    mesh.normals = angleWeightedNormals(mesh.positions, mesh.triangles);
  }
}

}  // namespace luciole
