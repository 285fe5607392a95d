#include "rays/shadow_rays.hpp"

#include <cmath>
#include <limits>
#include <memory>

#include "kernels/shared.h"
#include "luciole/validate_scene.hpp"
#include "raster/opacity.hpp"

namespace luciole {
namespace {

/// Decides whether a triangle blocks a ray.
struct Blockers {
  const Scene& scene;
  glm::dvec3 eye;
  std::vector<PlacedObject> objects;  ///< in world space

  bool passesThrough(const CandidateHit& candidate) const {
    const PlacedObject& object = objectOfTriangle(objects, candidate.triangle);
    const std::uint32_t in_mesh = candidate.triangle - object.first_triangle;
    const glm::uvec3 corners = object.mesh->triangles[in_mesh];
    return liesInPlane(object, corners, candidate.from) ||
           isHoleAt(scene, object, in_mesh,
                    {1 - candidate.second - candidate.third, candidate.second, candidate.third});
  }

  /// Whether a ray's start lies in a triangle's plane, to within its rounding. `from`: relative to the eye.
  bool liesInPlane(const PlacedObject& object, const glm::uvec3& corners, const glm::dvec3& from) const {
    const auto corner = [&](int i) {
      return glm::dvec3(object.object_to_view * glm::dvec4(object.mesh->positions[corners[i]], 1)) - eye;
    };
    const glm::dvec3 a = corner(0), normal = glm::cross(corner(1) - a, corner(2) - a);
    const double size = std::abs(from.x) + std::abs(from.y) + std::abs(from.z);
    return std::abs(glm::dot(normal, from - a)) <= POINT_ERROR * size * glm::length(normal);
  }
};

}  // namespace

RayScene buildShadowRays(const Scene& scene, const glm::dvec3& eye) {
  validateScene(scene);
  auto blockers = std::make_shared<const Blockers>(
      Blockers{scene, eye, placeObjects(scene, allObjects(scene), glm::dmat4(1))});
  return buildRayScene(
      scene, eye, [blockers](const CandidateHit& candidate) { return blockers->passesThrough(candidate); });
}

glm::dvec3 shadowStart(const GBuffer& gbuffer, std::size_t place) {
  const std::size_t stride = gbuffer.pixels();
  const auto triple = [&](const Plane& group) {
    return glm::dvec3(group[place], group[place + stride], group[place + 2 * stride]);
  };
  glm::dvec3 start = triple(gbuffer.position);
  if (!gbuffer.lift.empty()) start += double(gbuffer.lift[place]) * triple(gbuffer.normal);
  return glm::dvec3(gbuffer.camera.camera_to_world * glm::dvec4(start, 1));
}

ShadowRay shadowRay(const Light& light, const glm::dvec3& point) {
  const bool directional = light.kind == LightKind::kDirectional;
  const glm::dvec3 to_light = directional ? -light.direction : light.position - point;
  const double length = glm::length(to_light);
  return {point, to_light / length, directional ? std::numeric_limits<double>::infinity() : length};
}

}  // namespace luciole
