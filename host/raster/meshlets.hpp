#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "luciole/scene.hpp"

namespace luciole {

constexpr std::uint32_t kMeshletTriangles = 64;

/// Consecutive triangles of an object's mesh, which mostly lie close together, and the vertices that they
/// use.
struct Meshlet {
  std::uint32_t object;        ///< index into Scene::objects
  std::uint32_t first;         ///< triangle of its mesh
  std::uint32_t count;         ///< 1 to kMeshletTriangles
  std::uint32_t first_vertex;  ///< where its part of Meshlets::vertices begins
  std::uint32_t vertex_count;  ///< at most 3 · count
  glm::dvec3 low{0.0};         ///< world-space box around its finite corners
  glm::dvec3 high{0.0};
};

/// All triangles of a scene in meshlets, so that a view draws only those whose boxes it sees.
///
///     groups   box┬box┬…       one for kMeshletsPerGroup meshlets in a row
///     items    ┌──┴──┐
///              m   m   m   …   objects in order, each one's triangles in order
///     vertices 0 1 2 7│3 4 …   indices into the mesh, each once a meshlet; 4 bytes, at most 3 a triangle
///     corners  000…│121…│223…  of a meshlet's triangles the first, second and third corners, as places
///                              among its vertices; each kMeshletTriangles bytes
struct Meshlets {
  struct Box {
    glm::dvec3 low, high;
  };
  std::vector<Meshlet> items;
  std::vector<Box> groups;
  std::vector<std::uint32_t> vertices;
  std::vector<std::uint8_t> corners;  ///< 3 · kMeshletTriangles a meshlet
};
constexpr std::uint32_t kMeshletsPerGroup = 16;

/// The meshlets of all objects of a scene, in world space at its pose. O(triangles), in parallel.
Meshlets findMeshlets(const Scene& scene);

/// 0, 1, 2 …: every meshlet.
std::vector<std::uint32_t> allMeshlets(const Meshlets& meshlets);

}  // namespace luciole
