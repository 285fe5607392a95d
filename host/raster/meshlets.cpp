#include "raster/meshlets.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>

namespace luciole {
namespace {

constexpr std::size_t kRoom = 3 * kMeshletTriangles;  ///< vertices that a meshlet may use

/// Fills in a meshlet's corners, vertices (room for kRoom of either) and box.
void fillMeshlet(const Scene& scene, Meshlet& meshlet, std::uint32_t* vertices, std::uint8_t* corners) {
  const Object& object = scene.objects[meshlet.object];
  const Mesh& mesh = scene.meshes[object.mesh];
  // A hash table of the vertices used so far, by the low bits of their indices; 0xff: free.
  constexpr std::uint32_t kSlots = 256;
  static_assert(kRoom < kSlots);
  std::array<std::uint8_t, kSlots> slots;
  slots.fill(0xff);
  std::uint32_t count = 0;
  for (std::uint32_t i = 0; i < meshlet.count; ++i) {
    for (int c = 0; c < 3; ++c) {
      const std::uint32_t vertex = mesh.triangles[meshlet.first + i][c];
      std::uint32_t slot = vertex % kSlots;
      while (slots[slot] != 0xff && vertices[slots[slot]] != vertex) slot = (slot + 1) % kSlots;
      if (slots[slot] == 0xff) {
        slots[slot] = std::uint8_t(count);
        vertices[count++] = vertex;
      }
      corners[c * kMeshletTriangles + i] = slots[slot];
    }
  }
  meshlet.vertex_count = count;
  meshlet.low = glm::dvec3(std::numeric_limits<double>::infinity());
  meshlet.high = -meshlet.low;
  for (std::uint32_t i = 0; i < count; ++i) {
    const glm::dvec3 p(object.object_to_world * glm::dvec4(mesh.positions[vertices[i]], 1.0));
    meshlet.low = glm::min(meshlet.low, p);
    meshlet.high = glm::max(meshlet.high, p);
  }
}

}  // namespace

Meshlets findMeshlets(const Scene& scene) {
  Meshlets result;
  for (std::uint32_t object = 0; object < scene.objects.size(); ++object) {
    const std::size_t triangles = scene.meshes[scene.objects[object].mesh].triangles.size();
    for (std::size_t first = 0; first < triangles; first += kMeshletTriangles) {
      Meshlet& meshlet = result.items.emplace_back();
      meshlet.object = object;
      meshlet.first = std::uint32_t(first);
      meshlet.count = std::uint32_t(std::min<std::size_t>(kMeshletTriangles, triangles - first));
    }
  }
  const std::size_t count = result.items.size();
  std::vector<std::uint32_t> room(count * kRoom);
  result.corners.resize(count * kRoom);
  tbb::parallel_for(std::size_t(0), count, [&](std::size_t i) {
    fillMeshlet(scene, result.items[i], room.data() + i * kRoom, result.corners.data() + i * kRoom);
  });
  for (std::size_t i = 0; i < count; ++i) {
    Meshlet& meshlet = result.items[i];
    meshlet.first_vertex = std::uint32_t(result.vertices.size());
    const auto first = room.begin() + std::ptrdiff_t(i * kRoom);
    result.vertices.insert(result.vertices.end(), first, first + meshlet.vertex_count);
  }
  for (std::size_t first = 0; first < count; first += kMeshletsPerGroup) {
    result.groups.push_back({result.items[first].low, result.items[first].high});
    Meshlets::Box& box = result.groups.back();
    for (std::size_t i = first; i < std::min(count, first + kMeshletsPerGroup); ++i) {
      box.low = glm::min(box.low, result.items[i].low);
      box.high = glm::max(box.high, result.items[i].high);
    }
  }
  return result;
}

std::vector<std::uint32_t> allMeshlets(const Meshlets& meshlets) {
  std::vector<std::uint32_t> all(meshlets.items.size());
  std::iota(all.begin(), all.end(), 0u);
  return all;
}

}  // namespace luciole
