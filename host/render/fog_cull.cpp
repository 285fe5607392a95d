#include "render/fog_cull.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scene/load_scene.hpp"

namespace luciole {
namespace {

constexpr double kHalfStep = 0.5 / 255 / 12.92;

double brightestColor(const Scene& scene, float exposure) {
  float brightest = 1.0f;
  for (const Material& material : scene.materials)
    brightest = std::max({brightest, material.emission.x, material.emission.y, material.emission.z});
  return brightest * std::exp2(std::max(exposure, 0.0f));
}

/// Least depth of a box along the view axis. A distance from the eye is never smaller, so it serves radial
/// fog as well.
double nearestDepth(const Bounds& box, const View& view) {
  double nearest = std::numeric_limits<double>::infinity();
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec4 p((corner & 1 ? box.high : box.low).x, (corner & 2 ? box.high : box.low).y,
                       (corner & 4 ? box.high : box.low).z, 1.0);
    nearest = std::min(nearest, -(view.world_to_view * p).z);
  }
  return nearest;
}

}  // namespace

double fogLimit(const Fog& fog, double brightest) {
  const double infinite = std::numeric_limits<double>::infinity();
  const double share = kHalfStep / brightest;
  const double density = std::min({fog.density.x, fog.density.y, fog.density.z});
  switch (fog.mode) {
    case FogMode::kNone:
      return infinite;
    case FogMode::kLinear:
      return fog.end > fog.start ? fog.end - share * (fog.end - fog.start) : infinite;
    case FogMode::kExp:
      return density > 0 ? -std::log(share) / density : infinite;
    case FogMode::kExp2:
      return density > 0 ? std::sqrt(-std::log(share)) / density : infinite;
  }
  return infinite;
}

std::vector<std::uint32_t> objectsInSight(const Scene& scene, const View& view, float exposure) {
  const double brightest = brightestColor(scene, exposure);
  const double limit = fogLimit(scene.fog, brightest);
  const glm::vec3 contrast = glm::abs(scene.background - scene.fog.color);
  const bool can_hide =
      std::isfinite(limit) && std::max({contrast.x, contrast.y, contrast.z}) <= kHalfStep / brightest;
  std::vector<std::uint32_t> objects;
  for (std::uint32_t i = 0; i < scene.objects.size(); ++i)
    if (!can_hide || nearestDepth(objectBounds(scene, scene.objects[i]), view) <= limit) objects.push_back(i);
  return objects;
}

}  // namespace luciole
