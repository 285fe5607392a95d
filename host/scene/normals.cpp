#include "scene/normals.hpp"

#include <cmath>
#include <cstddef>

#include "luciole/scene.hpp"
#include "scene/check_vertices.hpp"
#include "scene/corners.hpp"

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

/// The cosine of the angle between triangles beyond which their edge is sharp, 60 degrees.
constexpr double kCreaseCosine = 0.5;

/// Triangles on both sides of a sharp edge get vertices of their own there, unless others join them around a
/// vertex.
void splitAtCreases(Mesh& mesh) {
  std::vector<glm::dvec3> facing;
  for (const glm::uvec3& corners : mesh.triangles)
    facing.push_back(
        faceNormal(mesh.positions[corners.x], mesh.positions[corners.y], mesh.positions[corners.z]));
  const auto vertexAt = [&](std::uint32_t corner) -> std::uint32_t& {
    return mesh.triangles[corner / 3][int(corner % 3)];
  };
  CornerGroups groups(3 * mesh.triangles.size());
  const std::vector<CornerEdge> edges = sortedEdges(
      mesh.triangles.size(), [](std::uint32_t) { return true; }, vertexAt);
  for (std::size_t i = 1; i < edges.size(); ++i) {
    const CornerEdge &a = edges[i - 1], &b = edges[i];
    if (!a.joins(b) || glm::dot(facing[a.low_corner / 3], facing[b.low_corner / 3]) < kCreaseCosine) continue;
    groups.join(a.low_corner, b.low_corner);
    groups.join(a.high_corner, b.high_corner);
  }
  // A vertex stays that of the first group that has it.
  constexpr std::uint32_t kNone = 0xffffffffu;
  std::vector<std::uint32_t> vertex_of_group(groups.parent.size(), kNone);
  std::vector<bool> is_taken(mesh.positions.size());
  for (std::uint32_t corner = 0; corner < groups.parent.size(); ++corner) {
    std::uint32_t& vertex = vertexAt(corner);
    std::uint32_t& own = vertex_of_group[groups.find(corner)];
    if (own == kNone) {
      own = is_taken[vertex] ? copyVertex(vertex, mesh) : vertex;
      if (own == vertex) is_taken[vertex] = true;
    }
    vertex = own;
  }
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
    checkVertices(scene, i);
    splitAtCreases(mesh);
    mesh.normals = angleWeightedNormals(mesh.positions, mesh.triangles);
  }
}

}  // namespace luciole
