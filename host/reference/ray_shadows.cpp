#include "reference/ray_shadows.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace luciole {
namespace {

/// The cone of directions in which a light is seen: its unit axis, 1 − the cosine of its half angle, and the
/// distance to the light's middle, metres; infinite for directional lights.
struct LightCone {
  glm::dvec3 axis;
  double one_minus_cosine;
  double distance;
};

LightCone lightCone(const Light& light, const glm::dvec3& point) {
  if (light.kind == LightKind::kDirectional) {
    const double half = std::sin(light.half_angle / 2);
    return {-glm::normalize(light.direction), 2 * half * half, std::numeric_limits<double>::infinity()};
  }
  const glm::dvec3 to_center = light.position - point;
  const double distance = glm::length(to_center), sine = std::min(light.radius / distance, 1.0);
  // Equals 1 − √(1 − s²), but keeps the digits of a small s.
  return {to_center / distance, sine * sine / (1 + std::sqrt(1 - sine * sine)), distance};
}

/// The distance to a sphere's surface along a ray. distance: to its middle; cosine: of the angle between the
/// ray and the direction to the middle.
double distanceToSphere(double distance, double radius, double cosine) {
  const double along = distance * cosine, across2 = distance * distance * (1 - cosine * cosine);
  return along - std::sqrt(std::max(radius * radius - across2, 0.0));
}

}  // namespace

double lightVisibility(const RayScene& rays, const Light& light, const glm::dvec3& point, int samples,
                       std::uint32_t seed) {
  const LightCone cone = lightCone(light, point);
  const bool directional = light.kind == LightKind::kDirectional;
  if (!directional && cone.distance <= light.radius) return 1;  // inside it
  if (cone.one_minus_cosine == 0) return isBlocked(rays, point, cone.axis, cone.distance) ? 0 : 1;

  const glm::dvec3 any = std::abs(cone.axis.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
  const glm::dvec3 right = glm::normalize(glm::cross(cone.axis, any)), up = glm::cross(right, cone.axis);
  // H. Vogel's spiral (1979): point i is at i golden angles, and equal solid angles lie between points.
  const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
  const double turn = seed * 0x1p-32 * 2 * std::numbers::pi;
  int visible = 0;
  for (int i = 0; i < samples; ++i) {
    const double drop = cone.one_minus_cosine * (i + 0.5) / samples, cosine = 1 - drop;
    const double sine = std::sqrt(drop * (1 + cosine)), angle = turn + i * golden;
    const glm::dvec3 direction = cosine * cone.axis + sine * (std::cos(angle) * right + std::sin(angle) * up);
    const double distance =
        directional ? cone.distance : distanceToSphere(cone.distance, light.radius, cosine);
    visible += !isBlocked(rays, point, direction, distance);
  }
  return double(visible) / samples;
}

}  // namespace luciole
