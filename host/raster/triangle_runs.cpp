#include "raster/triangle_runs.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>

namespace luciole {
namespace {

constexpr std::size_t kRoom = 3 * kRunTriangles;  ///< vertices that a run may use

/// Fills in a run's corners, vertices (room for kRoom of either) and box.
void fillRun(const Scene& scene, TriangleRun& run, std::uint32_t* vertices, std::uint8_t* corners) {
  const Object& object = scene.objects[run.object];
  const Mesh& mesh = scene.meshes[object.mesh];
  // The few vertices used so far, by the low bits of their indices.
  constexpr std::uint32_t kSlots = 256;
  static_assert(kRoom < kSlots);
  std::array<std::uint8_t, kSlots> slots;
  slots.fill(0xff);
  std::uint32_t count = 0;
  for (std::uint32_t i = 0; i < run.count; ++i) {
    for (int c = 0; c < 3; ++c) {
      const std::uint32_t vertex = mesh.triangles[run.first + i][c];
      std::uint32_t slot = vertex % kSlots;
      while (slots[slot] != 0xff && vertices[slots[slot]] != vertex) slot = (slot + 1) % kSlots;
      if (slots[slot] == 0xff) {
        slots[slot] = std::uint8_t(count);
        vertices[count++] = vertex;
      }
      corners[c * kRunTriangles + i] = slots[slot];
    }
  }
  run.vertex_count = count;
  run.low = glm::dvec3(std::numeric_limits<double>::infinity());
  run.high = -run.low;
  for (std::uint32_t i = 0; i < count; ++i) {
    const glm::dvec3 p(object.object_to_world * glm::dvec4(mesh.positions[vertices[i]], 1.0));
    run.low = glm::min(run.low, p);
    run.high = glm::max(run.high, p);
  }
}

}  // namespace

TriangleRuns findRuns(const Scene& scene) {
  TriangleRuns result;
  for (std::uint32_t object = 0; object < scene.objects.size(); ++object) {
    const std::size_t triangles = scene.meshes[scene.objects[object].mesh].triangles.size();
    for (std::size_t first = 0; first < triangles; first += kRunTriangles) {
      TriangleRun& run = result.runs.emplace_back();
      run.object = object;
      run.first = std::uint32_t(first);
      run.count = std::uint32_t(std::min<std::size_t>(kRunTriangles, triangles - first));
    }
  }
  const std::size_t count = result.runs.size();
  std::vector<std::uint32_t> room(count * kRoom);
  result.corners.resize(count * kRoom);
  tbb::parallel_for(std::size_t(0), count, [&](std::size_t i) {
    fillRun(scene, result.runs[i], room.data() + i * kRoom, result.corners.data() + i * kRoom);
  });
  for (std::size_t i = 0; i < count; ++i) {
    TriangleRun& run = result.runs[i];
    run.first_vertex = std::uint32_t(result.vertices.size());
    const auto first = room.begin() + std::ptrdiff_t(i * kRoom);
    result.vertices.insert(result.vertices.end(), first, first + run.vertex_count);
  }
  for (std::size_t first = 0; first < count; first += kRunsPerGroup) {
    result.groups.push_back({result.runs[first].low, result.runs[first].high});
    TriangleRuns::Box& box = result.groups.back();
    for (std::size_t i = first; i < std::min(count, first + kRunsPerGroup); ++i) {
      box.low = glm::min(box.low, result.runs[i].low);
      box.high = glm::max(box.high, result.runs[i].high);
    }
  }
  return result;
}

std::vector<std::uint32_t> allRuns(const TriangleRuns& runs) {
  std::vector<std::uint32_t> all(runs.runs.size());
  std::iota(all.begin(), all.end(), 0u);
  return all;
}

}  // namespace luciole
