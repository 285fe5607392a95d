#include "raster/triangle_runs.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <glm/gtc/matrix_access.hpp>
#include <limits>

namespace luciole {
namespace {

/// Bounds the rounding of clip coordinates, relative to the sum of their terms' magnitudes.
constexpr double kRounding = 0x1p-40;

TriangleRun makeRun(const Mesh& mesh, std::size_t number) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  TriangleRun run{glm::vec3(kInfinity), glm::vec3(-kInfinity), std::numeric_limits<std::uint32_t>::max(), 0};
  const std::size_t end = std::min(mesh.triangles.size(), (number + 1) * kRunTriangles);
  for (std::size_t i = number * kRunTriangles; i < end; ++i)
    for (int c = 0; c < 3; ++c) {
      const std::uint32_t vertex = mesh.triangles[i][c];
      run.low = glm::min(run.low, mesh.positions[vertex]);
      run.high = glm::max(run.high, mesh.positions[vertex]);
      run.first_vertex = std::min(run.first_vertex, vertex);
      run.end_vertex = std::max(run.end_vertex, vertex + 1);
    }
  return run;
}

std::vector<std::vector<double>> posesOf(const Scene& scene) {
  std::vector<std::vector<double>> poses;
  for (const Deformation& deformation : scene.animation.deformations) poses.push_back(deformation.pose);
  return poses;
}

}  // namespace

void updateRuns(const Scene& scene, bool divided, SceneRuns& runs) {
  std::vector<std::vector<double>> poses = posesOf(scene);
  const bool known = runs.of_mesh.size() == scene.meshes.size() && runs.poses.size() == poses.size() &&
                     runs.divided == divided;
  std::vector<std::uint8_t> wanted(scene.meshes.size(), !known);
  for (std::size_t i = 0; known && i < poses.size(); ++i)
    if (runs.poses[i] != poses[i]) wanted[scene.animation.deformations[i].mesh] = 1;
  runs.divided = divided;
  runs.poses = std::move(poses);
  runs.of_mesh.resize(scene.meshes.size());
  tbb::parallel_for(std::size_t(0), scene.meshes.size(), [&](std::size_t i) {
    if (!wanted[i]) return;
    const Mesh& plain = scene.meshes[i];
    const Mesh& mesh = divided && plain.divided ? *plain.divided : plain;
    runs.of_mesh[i].resize(runCount(mesh));
    tbb::parallel_for(std::size_t(0), runs.of_mesh[i].size(),
                      [&, i](std::size_t run) { runs.of_mesh[i][run] = makeRun(mesh, run); });
  });
}

void findSeenRuns(std::span<const TriangleRun> runs, const glm::dmat4& object_to_view,
                  const glm::dmat4& projection, std::span<std::uint8_t> seen) {
  const auto planesOf = [](const glm::dmat4& to_clip, double sign) {
    const glm::dvec4 x = glm::row(to_clip, 0), y = glm::row(to_clip, 1), z = glm::row(to_clip, 2),
                     w = glm::row(to_clip, 3);
    return std::array<glm::dvec4, 6>{w + x, w + sign * x, w + y, w + sign * y, w + sign * z, z};
  };
  const auto magnitudes = [](glm::dmat4 m) {
    for (int i = 0; i < 4; ++i) m[i] = glm::abs(m[i]);
    return m;
  };
  const std::array<glm::dvec4, 6> planes = planesOf(projection * object_to_view, -1);
  const std::array<glm::dvec4, 6> largest = planesOf(magnitudes(projection) * magnitudes(object_to_view), 1);
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const glm::dvec3 low(runs[i].low), high(runs[i].high), reach = glm::max(glm::abs(low), glm::abs(high));
    bool outside = false;
    for (int side = 0; side < 6; ++side) {
      const glm::dvec3 normal(planes[side]);
      const glm::dvec3 farthest = glm::max(normal * low, normal * high);
      const double inside = farthest.x + farthest.y + farthest.z + planes[side].w;
      const double rounding = kRounding * (glm::dot(glm::dvec3(largest[side]), reach) + largest[side].w);
      outside |= inside < -rounding;
    }
    seen[i] = !outside;
  }
}

}  // namespace luciole
