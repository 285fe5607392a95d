#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "luciole/scene.hpp"

namespace luciole {

constexpr std::uint32_t kRunTriangles = 64;

/// Consecutive triangles of a mesh, which mostly lie close together. 32 bytes.
struct TriangleRun {
  glm::vec3 low{0.0f}, high{0.0f};  ///< the box around their corners, in the mesh's space
  std::uint32_t first_vertex = 0;   ///< the range of the vertices that they use
  std::uint32_t end_vertex = 0;
};

/// Number of a mesh's runs: kRunTriangles triangles each, fewer in the last.
inline std::size_t runCount(const Mesh& mesh) {
  return (mesh.triangles.size() + kRunTriangles - 1) / kRunTriangles;
}

/// The runs of all meshes of a scene at its pose, for views that draw only those that they may see.
struct SceneRuns {
  bool divided = false;                           ///< of the meshes' divided forms, where they have one
  std::vector<std::vector<TriangleRun>> of_mesh;  ///< one list for each of Scene::meshes
  std::vector<std::vector<double>> poses;         ///< Deformation::pose of each of the scene's deformations
};

/// Brings the runs up to date: makes those of all meshes, or if it has them only of meshes that deformed.
/// Between calls meshes may change by deformations alone. O(triangles made), in parallel.
void updateRuns(const Scene& scene, bool divided, SceneRuns& runs);

/// Sets for each of a mesh's runs in `seen` whether a view may see any of it: 0 only if all its corners are
/// outside the same plane of the view volume, whatever the rounding.
void findSeenRuns(std::span<const TriangleRun> runs, const glm::dmat4& object_to_view,
                  const glm::dmat4& projection, std::span<std::uint8_t> seen);

}  // namespace luciole
