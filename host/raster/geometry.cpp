#include "raster/geometry.hpp"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <utility>

#include "luciole/error.hpp"
#include "raster/clip.hpp"

namespace luciole {
namespace {

/// The matrix that transforms normals: the inverse transpose times the absolute value of the determinant. Up
/// to its sign that is the matrix of cofactors, which exists for a singular matrix too, one that flattens the
/// object.
glm::dmat3 normalMatrix(const glm::dmat3& m, double determinant) {
  const glm::dmat3 cofactors(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
  return determinant < 0.0 ? -cofactors : cofactors;
}

constexpr std::size_t kBlock = 64;  ///< vertices that are transformed together, or not at all

/// Finds the runs that the view may see, and sets used[i] to 1 if one of them uses a vertex of block i.
void findUsed(const Scene& scene, const SceneRuns& runs, const View& view, Geometry& geometry,
              std::vector<std::uint8_t>& used) {
  tbb::parallel_for(std::size_t(0), geometry.objects.size(), [&](std::size_t number) {
    const PlacedObject& object = geometry.objects[number];
    const std::vector<TriangleRun>& of_mesh = runs.of_mesh[scene.objects[object.number].mesh];
    const std::span<std::uint8_t> seen = std::span(geometry.seen).subspan(object.first_run, of_mesh.size());
    findSeenRuns(of_mesh, object.object_to_view, view.projection, seen);
    for (std::size_t i = 0; i < seen.size(); ++i) {
      if (!seen[i]) continue;
      const std::size_t last = (object.first_vertex + of_mesh[i].end_vertex - 1) / kBlock;
      for (std::size_t block = (object.first_vertex + of_mesh[i].first_vertex) / kBlock; block <= last;
           ++block)
        std::atomic_ref(used[block]).store(1, std::memory_order_relaxed);  // shared with the next object
    }
  });
}

}  // namespace

std::vector<PlacedObject> placeObjects(const Scene& scene, std::span<const std::uint32_t> objects,
                                       const glm::dmat4& world_to_view, bool lit_vertices) {
  std::vector<PlacedObject> placed;
  placed.reserve(objects.size());
  std::size_t vertices = 0;
  std::size_t runs = 0;
  std::uint64_t triangles = 0;
  for (const std::uint32_t index : objects) {
    const Object& object = scene.objects[index];
    const Mesh& plain = scene.meshes[object.mesh];
    const Mesh& mesh = lit_vertices && plain.divided ? *plain.divided : plain;
    PlacedObject& place = placed.emplace_back();
    place.mesh = &mesh;
    place.number = index;
    place.material = object.material;
    place.first_vertex = vertices;
    place.first_triangle = std::uint32_t(triangles);
    place.first_run = runs;
    // The product in double first: far from the origin the translations cancel here, before positions are
    // rounded.
    place.object_to_view = world_to_view * object.object_to_world;
    const double determinant = glm::determinant(glm::dmat3(place.object_to_view));
    place.mirrored = determinant < 0.0;
    place.normal_to_view = normalMatrix(glm::dmat3(place.object_to_view), determinant);
    vertices += mesh.positions.size();
    triangles += mesh.triangles.size();
    runs += runCount(mesh);
    if (triangles >= kNoTriangle)
      throw InputError(fmt::format("{}: objects: {} triangles or more, expected fewer than {}", scene.name,
                                   triangles, kNoTriangle));
  }
  return placed;
}

Geometry transformObjects(const Scene& scene, std::span<const std::uint32_t> objects, const View& view,
                          bool lit_vertices, const SceneRuns* runs, Geometry recycled) {
  Geometry geometry = std::move(recycled);
  geometry.objects = placeObjects(scene, objects, view.world_to_view, lit_vertices);
  std::size_t vertices = 0, run_count = 0;
  geometry.triangle_count = 0;
  if (!geometry.objects.empty()) {
    const PlacedObject& last = geometry.objects.back();
    vertices = last.first_vertex + last.mesh->positions.size();
    run_count = last.first_run + runCount(*last.mesh);
    geometry.triangle_count = last.first_triangle + std::uint32_t(last.mesh->triangles.size());
  }
  geometry.positions.resize(vertices);
  geometry.screen.resize(vertices);
  geometry.places.resize(vertices);
  geometry.seen.assign(run_count, 1);
  // Whether any vertex of each kBlock is used by a run seen.
  std::vector<std::uint8_t> used((vertices + kBlock - 1) / kBlock, !runs);
  if (runs) findUsed(scene, *runs, view, geometry, used);
  const ClipVolume volume = clipVolume(view);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, used.size(), 64), [&](const auto& range) {
    const std::size_t first = range.begin() * kBlock;
    auto object = std::upper_bound(geometry.objects.begin(), geometry.objects.end(), first,
                                   [](std::size_t v, const PlacedObject& o) { return v < o.first_vertex; }) -
                  1;
    for (std::size_t block = range.begin(); block < range.end(); ++block) {
      if (!used[block]) continue;
      for (std::size_t i = block * kBlock, block_end = std::min(vertices, i + kBlock); i < block_end;) {
        while (i >= object->first_vertex + object->mesh->positions.size()) ++object;
        const std::vector<glm::vec3>& positions = object->mesh->positions;
        const std::size_t end = std::min(block_end, object->first_vertex + positions.size());
        for (; i < end; ++i) {
          geometry.positions[i] =
              glm::dvec3(object->object_to_view * glm::dvec4(positions[i - object->first_vertex], 1.0));
          const glm::dvec4 clip = view.projection * glm::dvec4(geometry.positions[i], 1.0);
          geometry.screen[i] = toScreen(clip, view);
          geometry.places[i] = std::uint16_t(vertexPlace(geometry.positions[i], clip, volume.guard));
        }
      }
    }
  });
  return geometry;
}

const PlacedObject& objectOfTriangle(const std::vector<PlacedObject>& objects, std::uint32_t triangle) {
  return *(std::upper_bound(
               objects.begin(), objects.end(), triangle,
               [](std::uint32_t t, const PlacedObject& object) { return t < object.first_triangle; }) -
           1);
}

}  // namespace luciole
