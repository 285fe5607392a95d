#include "scene/light_field.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <new>

#include "error.hpp"

namespace luciole {
namespace {

/// SplitMix64 (Steele, Lea and Flood 2014, "Fast splittable pseudorandom number generators").
std::uint64_t nextBits(std::uint64_t& state) {
  std::uint64_t z = state += 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

/// Uniform in [0,1), a multiple of 2⁻⁵³.
double nextUniform(std::uint64_t& state) { return static_cast<double>(nextBits(state) >> 11) * 0x1p-53; }

double between(double low, double high, double u) { return std::min(low + u * (high - low), high); }

// Only + − × and the square root below: they round the same way everywhere, sine and logarithm don't.

glm::dvec3 pointInBall(std::uint64_t& state) {
  for (;;) {
    glm::dvec3 point;
    for (int i = 0; i < 3; ++i) point[i] = 2 * nextUniform(state) - 1;
    if (point.x * point.x + point.y * point.y + point.z * point.z <= 1) return point;
  }
}

/// Marsaglia 1972, "Choosing a point from the surface of a sphere".
glm::dvec3 pointOnSphere(std::uint64_t& state) {
  for (;;) {
    const double a = 2 * nextUniform(state) - 1;
    const double b = 2 * nextUniform(state) - 1;
    const double s = a * a + b * b;
    if (s < 1) return {2 * a * std::sqrt(1 - s), 2 * b * std::sqrt(1 - s), 1 - 2 * s};
  }
}

glm::dvec3 pointOf(const LightField& field, std::uint64_t& state) {
  switch (field.shape) {
    case FieldShape::kBall:
      return field.center + field.radius * pointInBall(state);
    case FieldShape::kSphere:
      return field.center + field.radius * pointOnSphere(state);
    case FieldShape::kBox:
      break;
  }
  glm::dvec3 point;
  for (int i = 0; i < 3; ++i) point[i] = between(field.low[i], field.high[i], nextUniform(state));
  return point;
}

}  // namespace

void expandLightField(const LightField& field, std::vector<Light>& lights) {
  if (field.count > kMostLights || lights.size() > kMostLights - field.count) {
    throw InputError(fmt::format("light field: {} lights and {} more; a scene may have {} at most",
                                 lights.size(), field.count, kMostLights));
  }
  try {
    lights.reserve(lights.size() + field.count);
  } catch (const std::bad_alloc&) {
    throw MachineError(fmt::format("light field: no memory for {} lights", field.count));
  }
  std::uint64_t place_state = field.seed;
  // Looks have a stream of their own, so that changing them moves no light.
  std::uint64_t look_state = ~field.seed;
  for (std::uint64_t i = 0; i < field.count; ++i) {
    Light light;
    light.position = pointOf(field, place_state);
    const double pick = nextUniform(look_state) * static_cast<double>(field.colors.size());
    const double intensity = between(field.intensity.x, field.intensity.y, nextUniform(look_state));
    const double range_u = nextUniform(look_state);
    light.diffuse = field.colors[static_cast<std::size_t>(pick)] * static_cast<float>(intensity);
    light.specular = light.diffuse;
    light.attenuation = field.attenuation;
    if (std::isfinite(field.range.y)) {
      light.range = static_cast<float>(between(field.range.x, field.range.y, range_u));
    }
    light.shadow = field.shadow;
    lights.push_back(light);
  }
}

}  // namespace luciole
