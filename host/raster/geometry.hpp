#pragma once

#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <span>
#include <vector>

#include "luciole/array_memory.hpp"
#include "luciole/scene.hpp"
#include "raster/clip.hpp"
#include "raster/triangle_runs.hpp"
#include "raster/view.hpp"

namespace luciole {

/// An object to draw. Vertices and triangles are numbered through all objects to draw, in order. It refers to
/// the scene's mesh.
struct PlacedObject {
  const Mesh* mesh = nullptr;
  std::uint32_t number = 0;  ///< in Scene::objects
  int material = -1;         ///< as in Object
  std::size_t first_vertex = 0;
  std::uint32_t first_triangle = 0;
  std::size_t first_run = 0;  ///< of the runs of all objects, in order
  bool mirrored = false;      ///< its transform turns counter-clockwise triangles clockwise
  glm::dmat4 object_to_view{1.0};
  glm::dmat3 normal_to_view{1.0};  ///< gives the direction, not the length
};

/// Stands for no triangle, in place of a number.
constexpr std::uint32_t kNoTriangle = 0xffffffffu;

/// Places the given objects (indices into scene.objects) in view space. `lit_vertices`: take the meshes'
/// divided forms (Mesh::divided), for colours that are lit at vertices. The result refers to the scene.
/// O(objects). Throws InputError where there are too many triangles for 32-bit numbers.
std::vector<PlacedObject> placeObjects(const Scene& scene, std::span<const std::uint32_t> objects,
                                       const glm::dmat4& world_to_view, bool lit_vertices = false);

/// A vertex on the picture: pixels from the sample of the whole picture's pixel (0,0), x right, y down;
/// reversed depth.
struct ScreenVertex {
  double x;
  double y;
  double depth;
};

/// Where a vertex lies relative to the view volume; bits to be combined.
enum VertexPlace : std::uint16_t {
  kBehindNear = 1,
  kBeyondFar = 2,
  kLeftOf = 4,
  kRightOf = 8,
  kBelow = 16,
  kAbove = 32,
  kOutsideVolume = 63,  ///< any of the above
  kOutsideGuard = 64,   ///< see clip.hpp
  kUnusable = 128,      ///< not finite, in double or as float
};

/// The vertices of the objects to draw, seen by a view. Those that no run seen uses are undefined.
struct Geometry {
  std::vector<PlacedObject> objects;
  std::uint32_t triangle_count = 0;
  std::vector<std::uint8_t> seen;  ///< for each run of each object, in order, 0: all of it is outside
  RawArray<glm::dvec3> positions;  ///< view space
  RawArray<ScreenVertex> screen;   ///< meaningless behind the near plane
  RawArray<std::uint16_t> places;  ///< VertexPlace bits
};

/// Perspective division and viewport; meaningless unless clip.w > 0.
inline ScreenVertex toScreen(const glm::dvec4& clip, const View& view) {
  const double inverse_w = 1.0 / clip.w;
  return {(0.5 + 0.5 * (clip.x * inverse_w)) * view.size.x - view.sample.x,
          (0.5 - 0.5 * (clip.y * inverse_w)) * view.size.y - view.sample.y, clip.z * inverse_w};
}

/// VertexPlace bits of a vertex at `position` in view space and `clip` in clip space; `guard`: see
/// ClipVolume. A vertex that isn't `placed` counts as outside it. Without branches, so that loops over
/// vertices are vectorized.
inline std::uint32_t vertexPlace(const glm::dvec3& position, const glm::dvec4& clip, const glm::dvec2& guard,
                                 bool placed = true) {
  const double largest = std::abs(position.x) + std::abs(position.y) + std::abs(position.z);
  const double sum = clip.x + clip.y + clip.z + clip.w;
  const bool usable = (largest <= double(std::numeric_limits<float>::max())) &
                      (std::abs(sum) <= std::numeric_limits<double>::max());
  const bool outside_guard =
      (std::abs(clip.x) > guard.x * clip.w) | (std::abs(clip.y) > guard.y * clip.w) | !placed;
  return (clip.z > clip.w ? kBehindNear : 0) | (clip.z < 0.0 ? kBeyondFar : 0) |
         (clip.x < -clip.w ? kLeftOf : 0) | (clip.x > clip.w ? kRightOf : 0) |
         (clip.y < -clip.w ? kBelow : 0) | (clip.y > clip.w ? kAbove : 0) |
         (outside_guard ? kOutsideGuard : 0) | (usable ? 0 : kUnusable);
}

/// Transforms the vertices of the given objects, in parallel. `lit_vertices` and errors: as in placeObjects.
/// `runs`: of the scene at its pose, of this form of its meshes; null: all runs count as seen. `recycled`:
/// its memory is reused. 50 bytes a vertex.
Geometry transformObjects(const Scene& scene, std::span<const std::uint32_t> objects, const View& view,
                          bool lit_vertices = false, const SceneRuns* runs = nullptr, Geometry recycled = {});

/// The object that a triangle belongs to, by the triangle's number among all. O(log objects).
const PlacedObject& objectOfTriangle(const std::vector<PlacedObject>& objects, std::uint32_t triangle);

/// The material of triangle `in_mesh` of an object's mesh.
inline const Material& materialOf(const Scene& scene, const PlacedObject& object, std::uint32_t in_mesh) {
  return scene.materials[object.material >= 0 ? std::uint32_t(object.material)
                                              : object.mesh->triangle_materials[in_mesh]];
}

/// Whether the eye lies on the side of a plane that its normal points to, in view space; `point` lies in the
/// plane. Right for triangles that reach behind the eye too (the homogeneous test of Olano and Greer,
/// "Triangle scan conversion using 2D homogeneous coordinates", 1997, in view space).
inline bool eyeInFront(const glm::dvec3& normal, const glm::dvec3& point, bool perspective) {
  return perspective ? glm::dot(normal, point) < 0.0 : normal.z > 0.0;
}

/// Whether a view is perspective; otherwise it is parallel.
inline bool isPerspective(const View& view) { return view.projection[2][3] != 0.0; }

/// Where the view's axis meets the picture, in normalized device coordinates: Camera::shift.
inline glm::dvec2 axisInPicture(const View& view) {
  return isPerspective(view) ? glm::dvec2(0) - glm::dvec2(view.projection[2])
                             : glm::dvec2(view.projection[3]);
}

}  // namespace luciole
