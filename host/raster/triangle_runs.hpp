#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "scene/scene.hpp"

namespace luciole {

constexpr std::uint32_t kRunTriangles = 64;

/// Triangles of an object that follow each other in its mesh, which mostly lie close together, with the
/// vertices that they use.
struct TriangleRun {
  std::uint32_t object;        ///< index into Scene::objects
  std::uint32_t first;         ///< triangle of its mesh
  std::uint32_t count;         ///< 1 to kRunTriangles
  std::uint32_t first_vertex;  ///< of its part of TriangleRuns::vertices
  std::uint32_t vertex_count;  ///< at most 3 · count
  glm::dvec3 low{0.0};         ///< world-space box around its finite corners
  glm::dvec3 high{0.0};
};

/// All triangles of a scene in runs, so that a view that sees little of it draws little.
///
///     groups   box┬box┬…       one for kRunsPerGroup runs in a row
///     runs     ┌──┴──┐
///              run run run …   objects in order, each one's triangles in order
///     vertices 0 1 2 7│3 4 …   indices into the mesh, each once a run: 4 bytes each, at most 3 a triangle
///     corners  000…│121…│223…  the triangles' first corners, second and third, as places in their run's
///                              vertices: kRunTriangles bytes each
struct TriangleRuns {
  struct Box {
    glm::dvec3 low, high;
  };
  std::vector<TriangleRun> runs;
  std::vector<Box> groups;
  std::vector<std::uint32_t> vertices;
  std::vector<std::uint8_t> corners;  ///< 3 · kRunTriangles a run
};
constexpr std::uint32_t kRunsPerGroup = 16;

TriangleRuns findRuns(const Scene& scene);

/// 0, 1, 2 …: every run.
std::vector<std::uint32_t> allRuns(const TriangleRuns& runs);

}  // namespace luciole
