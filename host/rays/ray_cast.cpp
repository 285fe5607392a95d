#include "rays/ray_cast.hpp"

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>

#include "luciole/error.hpp"
#include "scene/count_triangles.hpp"

namespace luciole {
namespace {

/// Embree's filter callback: asks the HitFilter about each hit of a packet.
void filterHits(const RTCFilterFunctionNArguments* arguments) {
  const auto& hit_filter = *static_cast<const HitFilter*>(arguments->geometryUserPtr);
  const unsigned n = arguments->N;
  for (unsigned i = 0; i < n; ++i) {
    if (arguments->valid[i] == 0) continue;
    RTCRayN* ray = arguments->ray;
    RTCHitN* hit = arguments->hit;
    const CandidateHit candidate{
        {RTCRayN_org_x(ray, n, i), RTCRayN_org_y(ray, n, i), RTCRayN_org_z(ray, n, i)},
        RTCHitN_primID(hit, n, i),
        RTCHitN_u(hit, n, i),
        RTCHitN_v(hit, n, i)};
    if (hit_filter(candidate)) arguments->valid[i] = 0;
  }
}

RTCRay makeRay(const RayScene& scene, const glm::dvec3& from, const glm::dvec3& direction, double distance) {
  const glm::vec3 o = from - scene.origin, d = direction;
  RTCRay ray{};
  ray.org_x = o.x;
  ray.org_y = o.y;
  ray.org_z = o.z;
  ray.dir_x = d.x;
  ray.dir_y = d.y;
  ray.dir_z = d.z;
  ray.tfar = static_cast<float>(distance);
  ray.mask = ~0u;
  return ray;
}

/// Whether Embree accepts the ray: it ends the program for components of origin or direction
/// beyond 1.844·10¹⁸ or NaN. Such rays occur in scenes of 10¹⁸ metres, and from a point to itself. They hit
/// nothing.
bool canBeCast(const RTCRay& ray) {
  constexpr float kLargest = 1.8e18f;
  bool valid = !std::isnan(ray.tfar);
  for (const float value : {ray.org_x, ray.org_y, ray.org_z, ray.dir_x, ray.dir_y, ray.dir_z})
    valid &= std::abs(value) <= kLargest;
  return valid;
}

constexpr std::size_t kPacketSize = 16;
/// Packets that a task traces.
constexpr std::size_t kPacketsPerTask = 64;

/// Traces one packet of 1 to 16 rays. Unused rays have tfar < tnear as well: without AVX-512 Embree 3
/// treats 16 rays as a stream and ignores `valid`.
void askPacket(const RayScene& scene, std::span<const ShadowRay> rays, std::span<std::uint8_t> blocked) {
  alignas(64) std::array<int, kPacketSize> valid{};
  RTCRay16 packet{};
  std::fill(std::begin(packet.tfar), std::end(packet.tfar), -1.0f);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const RTCRay ray = makeRay(scene, rays[i].from, rays[i].direction, rays[i].distance);
    if (!canBeCast(ray)) continue;
    packet.org_x[i] = ray.org_x;
    packet.org_y[i] = ray.org_y;
    packet.org_z[i] = ray.org_z;
    packet.dir_x[i] = ray.dir_x;
    packet.dir_y[i] = ray.dir_y;
    packet.dir_z[i] = ray.dir_z;
    packet.tfar[i] = ray.tfar;
    packet.mask[i] = ray.mask;
    valid[i] = -1;
  }
#if RTC_VERSION_MAJOR >= 4
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
  rtcOccluded16(valid.data(), scene.scene.get(), &packet, &arguments);
#else
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcOccluded16(valid.data(), scene.scene.get(), &context, &packet);
#endif
  for (std::size_t i = 0; i < rays.size(); ++i) blocked[i] = valid[i] && packet.tfar[i] < 0;
}

/// Writes the objects' vertices, relative to rays.origin, and their triangles, and fills rays.mirrored.
void placeTriangles(const Scene& scene, RayScene& rays, glm::vec3* vertex, glm::uvec3* triangle) {
  std::uint32_t first = 0;
  for (const Object& object : scene.objects) {
    const Mesh& mesh = scene.meshes[object.mesh];
    for (const glm::vec3& position : mesh.positions)
      *vertex++ = glm::dvec3(object.object_to_world * glm::dvec4(position, 1)) - rays.origin;
    for (const glm::uvec3& corners : mesh.triangles) *triangle++ = corners + first;
    first += std::uint32_t(mesh.positions.size());
    const bool mirrored = glm::determinant(glm::dmat3(object.object_to_world)) < 0;
    rays.mirrored.insert(rays.mirrored.end(), mesh.triangles.size(), mirrored);
  }
}

}  // namespace

RayScene buildRayScene(const Scene& scene, const glm::dvec3& origin, HitFilter hit_filter) {
  const std::shared_ptr<RTCDeviceTy> device(rtcNewDevice(nullptr), rtcReleaseDevice);
  if (!device) throw MachineError("Embree can't be started");
  RayScene result;
  result.origin = origin;
  // The scene keeps its device alive.
  result.scene.reset(rtcNewScene(device.get()), [device](RTCScene built) { rtcReleaseScene(built); });
  rtcSetSceneFlags(result.scene.get(), RTC_SCENE_FLAG_ROBUST);

  const std::size_t count = countTriangles(scene);
  std::size_t vertex_count = 0;
  for (const Object& object : scene.objects) vertex_count += scene.meshes[object.mesh].positions.size();
  const RTCGeometry geometry = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertices = static_cast<glm::vec3*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(glm::vec3), vertex_count));
  auto* triangles = static_cast<glm::uvec3*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(glm::uvec3), count));
  if (count > 0 && (!vertices || !triangles))
    throw MachineError(scene.name + ": no memory for its triangles in Embree");
  placeTriangles(scene, result, vertices, triangles);
  if (hit_filter) {
    result.hit_filter = std::make_shared<const HitFilter>(std::move(hit_filter));
    rtcSetGeometryUserData(geometry, const_cast<HitFilter*>(result.hit_filter.get()));
    rtcSetGeometryIntersectFilterFunction(geometry, filterHits);
    rtcSetGeometryOccludedFilterFunction(geometry, filterHits);
  }
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(result.scene.get(), geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(result.scene.get());
  return result;
}

std::optional<RayHit> castRay(const RayScene& scene, const glm::dvec3& from, const glm::dvec3& direction) {
  RTCRayHit query{};
  query.ray = makeRay(scene, from, direction, std::numeric_limits<float>::infinity());
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  if (!canBeCast(query.ray)) return std::nullopt;
#if RTC_VERSION_MAJOR >= 4
  rtcIntersect1(scene.scene.get(), &query);
#else
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(scene.scene.get(), &context, &query);
#endif
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  const glm::vec3 normal(query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z);
  const bool against = glm::dot(normal, glm::vec3(direction)) < 0;
  return RayHit{query.ray.tfar, against != scene.mirrored[query.hit.primID], query.hit.primID};
}

bool isBlocked(const RayScene& scene, const glm::dvec3& from, const glm::dvec3& direction, double distance) {
  RTCRay ray = makeRay(scene, from, direction, distance);
  if (!canBeCast(ray)) return false;
#if RTC_VERSION_MAJOR >= 4
  rtcOccluded1(scene.scene.get(), &ray);
#else
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(scene.scene.get(), &context, &ray);
#endif
  return ray.tfar < 0;  // Embree sets it to −inf for a hit
}

void areBlocked(const RayScene& scene, std::span<const ShadowRay> rays, std::span<std::uint8_t> blocked) {
  const std::size_t packets = (rays.size() + kPacketSize - 1) / kPacketSize;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, packets, kPacketsPerTask), [&](const auto& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      const std::size_t first = i * kPacketSize, count = std::min(kPacketSize, rays.size() - first);
      askPacket(scene, rays.subspan(first, count), blocked.subspan(first, count));
    }
  });
}

}  // namespace luciole
