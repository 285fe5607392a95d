#include "scene/ray_cast.hpp"

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <algorithm>
#include <limits>

#include "error.hpp"

namespace luciole {
namespace {

std::size_t countTriangles(const Scene& scene) {
  std::size_t count = 0;
  for (const Object& object : scene.objects) count += scene.meshes[object.mesh].triangles.size();
  return count;
}

/// Fills three corners a triangle, counter-clockwise seen from its front.
void placeCorners(const Scene& scene, const glm::dvec3& origin, glm::vec3* corner) {
  for (const Object& object : scene.objects) {
    const Mesh& mesh = scene.meshes[object.mesh];
    const bool mirrored = glm::determinant(glm::dmat3(object.object_to_world)) < 0;
    for (glm::uvec3 triangle : mesh.triangles) {
      if (mirrored) std::swap(triangle.y, triangle.z);
      for (int i = 0; i < 3; ++i)
        *corner++ = glm::dvec3(object.object_to_world * glm::dvec4(mesh.positions[triangle[i]], 1)) - origin;
    }
  }
}

}  // namespace

RayScene buildRayScene(const Scene& scene, const glm::dvec3& origin) {
  const std::shared_ptr<RTCDeviceTy> device(rtcNewDevice(nullptr), rtcReleaseDevice);
  if (!device) throw MachineError("Embree can't be started");
  RayScene result;
  result.origin = origin;
  // The scene keeps its device alive.
  result.scene.reset(rtcNewScene(device.get()), [device](RTCScene built) { rtcReleaseScene(built); });
  rtcSetSceneFlags(result.scene.get(), RTC_SCENE_FLAG_ROBUST);

  const std::size_t count = countTriangles(scene);
  const RTCGeometry geometry = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* corners = static_cast<glm::vec3*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(glm::vec3), 3 * count));
  auto* indices = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), count));
  if (count > 0 && (!corners || !indices))
    throw MachineError(scene.name + ": no memory for its triangles in Embree");
  placeCorners(scene, origin, corners);
  for (std::size_t i = 0; i < 3 * count; ++i) indices[i] = static_cast<std::uint32_t>(i);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(result.scene.get(), geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(result.scene.get());
  return result;
}

std::optional<RayHit> castRay(const RayScene& scene, const glm::dvec3& from, const glm::dvec3& direction) {
  const glm::vec3 o = from - scene.origin, d = direction;
  RTCRayHit query{};
  query.ray.org_x = o.x;
  query.ray.org_y = o.y;
  query.ray.org_z = o.z;
  query.ray.dir_x = d.x;
  query.ray.dir_y = d.y;
  query.ray.dir_z = d.z;
  query.ray.tfar = std::numeric_limits<float>::infinity();
  query.ray.mask = ~0u;
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
#if RTC_VERSION_MAJOR >= 4
  rtcIntersect1(scene.scene.get(), &query);
#else
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(scene.scene.get(), &context, &query);
#endif
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  const bool front = glm::dot(glm::vec3(query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z), d) < 0;
  return RayHit{query.ray.tfar, front, query.hit.primID};
}

}  // namespace luciole
