#include "shadow/maps/shadow_sizes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "luciole/error.hpp"
#include "raster/geometry.hpp"
#include "shadow/maps/frustum.hpp"

namespace luciole {
namespace {

/// Texels a side with which a texel, halfway to the light's reach, is as large as what a pixel covers at the
/// light's distance from the camera (at least half the reach). 0 where the light reaches nothing of the
/// picture.
double wantedSize(const Light& light, const PlanInput& input) {
  const double reach = lightReach(light, input.bounds);
  const glm::dmat4& projection = input.camera.projection;
  const glm::dvec3 place(input.camera.world_to_view * glm::dvec4(light.position, 1));
  for (const glm::dvec4& plane : cropPlanes(input.camera))
    if (glm::dot(plane, glm::dvec4(light.position, 1)) < -reach * glm::length(glm::dvec3(plane))) return 0;
  // A pixel's shorter side in metres, at one metre ahead if the view is a perspective one.
  double pixel = std::min(input.camera.pixel_aspect, 1.0) * 2 / (projection[1][1] * input.camera.size.y);
  if (isPerspective(input.camera)) pixel *= std::max(glm::length(place), 0.5 * reach);
  const double tangent = usesCubeMap(light) ? 1.0 : std::tan(light.cutoff);
  return reach * tangent / pixel;
}

int largestSize(const Light& light, const ShadowLimits& limits) {
  return std::max(usesCubeMap(light) ? limits.size / 2 : limits.size, kSmallestFace);
}

/// A face's texels a side: `wanted` and the border on both sides, from kSmallestFace to `largest`.
int withBorder(double wanted, ShadowMethod method, int largest) {
  const double size = std::ceil(std::min(wanted, double(largest)));
  return std::clamp(int(size) + 2 * borderOf(int(size), method), kSmallestFace, largest);
}

}  // namespace

ShadowSizes chooseSizes(const Scene& scene, const PlanInput& input, const ShadowLimits& limits) {
  ShadowSizes result{std::vector<int>(scene.lights.size(), 0)};
  std::vector<int>& wanted = result.sizes;
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    const Light& light = scene.lights[i];
    if (!light.shadow || (!input.ways.empty() && input.ways[i] != ShadowWay::kMap)) continue;
    const int largest = largestSize(light, limits);
    wanted[i] = light.kind == LightKind::kDirectional
                    ? largest
                    : withBorder(wantedSize(light, input), input.method, largest);
  }
  const auto scaled = [](int size, double scale) { return std::max(int(size * scale), kSmallestFace); };
  const auto bytesAt = [&](double scale) {
    double texels = 0;
    for (std::size_t i = 0; i < wanted.size(); ++i)
      if (wanted[i] > 0) texels += facesOf(scene.lights[i]) * std::pow(double(scaled(wanted[i], scale)), 2);
    return texels * sizeof(ShadowTexel);
  };
  double scale = 1;
  while (bytesAt(scale) > double(limits.bytes)) {
    if (scale < 1e-4)
      throw MachineError(fmt::format("{}: the shadow maps of its lights don't fit into {} MiB", scene.name,
                                     limits.bytes >> 20));
    scale *= 0.95;
  }
  for (int& size : wanted) {
    if (size == 0) continue;
    const int less = scaled(size, scale);
    result.reduced_lights += less < size;
    size = less;
  }
  return result;
}

}  // namespace luciole
