#include "lights/shade_lights.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "lights/light_tree.hpp"
#include "raster/view.hpp"

namespace luciole {
namespace {

/// Metres. The square of a few times this is still a finite float.
constexpr double kFarthestLight = 1e18;
/// Cosine of the narrowest cutoff. The kernels' cosine of 1 may be off by 12 · 2⁻²⁴, and the axis has to stay
/// inside the cone.
constexpr double kNarrowestEdge = 1 - 12 * 0x1p-24;

/// Prefetch distance in lights, enough to hide the latency of memory.
constexpr std::size_t kLightsAhead = 12;

void prefetchToWrite(const ShadeLight& light) {
  constexpr std::size_t kLine = 64;
  const char* bytes = reinterpret_cast<const char*>(&light);
  for (std::size_t i = 0; i < sizeof(ShadeLight); i += kLine) __builtin_prefetch(bytes + i, 1);
  __builtin_prefetch(bytes + sizeof(ShadeLight) - 1, 1);
}

constexpr std::uint32_t kNoPlace = std::numeric_limits<std::uint32_t>::max();

/// The place of each of `lights` lights in `order`, or kNoPlace.
RawArray<std::uint32_t> placesIn(std::span<const std::uint32_t> order, std::size_t lights) {
  RawArray<std::uint32_t> places(lights);
  if (order.size() < lights) std::fill(places.begin(), places.end(), kNoPlace);
  tbb::parallel_for(std::size_t(0), order.size(),
                    [&](std::size_t i) { places[order[i]] = std::uint32_t(i); });
  return places;
}

float4 pack(const glm::dvec3& xyz, double w) { return {float(xyz.x), float(xyz.y), float(xyz.z), float(w)}; }

}  // namespace

RawArray<ShadeLight> prepareLights(const Scene& scene, std::span<const std::uint32_t> order,
                                   const Camera& camera, std::span<const std::uint32_t> map_of_light) {
  const glm::dmat4 world_to_view = worldToView(camera);
  const glm::dmat3 rotation(world_to_view);
  RawArray<ShadeLight> result(order.size());
  // The order is that of space, not of memory. Lights are read in the order of memory, since the scene's take
  // more of it, and in small pages.
  const RawArray<std::uint32_t> places = placesIn(order, scene.lights.size());
  tbb::parallel_for(std::size_t(0), places.size(), [&](std::size_t i) {
    if (places[i] == kNoPlace) return;
    if (i + kLightsAhead < places.size() && places[i + kLightsAhead] != kNoPlace)
      prefetchToWrite(result[places[i + kLightsAhead]]);
    const Light& light = scene.lights[i];
    ShadeLight& out = result[places[i]];
    const glm::dvec3 shines = rotation * light.direction;
    const double range = light.range;
    const double inverse_range2 = light.kind == LightKind::kDirectional ? 0.0 : 1.0 / (range * range);
    const double edge = light.cutoff == 0 ? kNarrowestEdge : std::min(std::cos(light.cutoff), kNarrowestEdge);
    double cone_scale = 0;
    // Light from farther away than kFarthestLight comes from the same direction at every visible point. So
    // the light may be moved nearer, by this factor, if its falloff is scaled to match.
    double nearer = 1;
    if (light.kind == LightKind::kDirectional) {
      out.kind = kDirectionalLight;
      out.position = pack(-shines, 0);
    } else {
      out.kind = light.kind == LightKind::kSpot ? kSpotLight : kPointLight;
      const glm::dvec3 place(world_to_view * glm::dvec4(light.position, 1));
      if (std::max({std::abs(place.x), std::abs(place.y), std::abs(place.z)}) > kFarthestLight / 2)
        nearer = std::max(glm::length(place) / kFarthestLight, 1.0);
      out.position = pack(place / nearer, inverse_range2 * nearer * nearer);
      if (light.falloff == SpotFalloff::kCone)
        cone_scale = 1.0 / std::max(std::cos(light.inner_cone) - edge, 1e-6);
    }
    out.direction = pack(shines, edge);
    out.diffuse = pack(light.diffuse, light.exponent);
    out.specular = pack(light.specular, cone_scale);
    out.ambient = pack(light.ambient, 0);
    out.attenuation =
        pack(glm::dvec3(light.attenuation) * glm::dvec3(1, nearer, nearer * nearer), light.cell);
    out.khr_window = light.window == RangeWindow::kKhr;
    out.cone = light.falloff == SpotFalloff::kCone;
    out.shadow = map_of_light.empty() ? kNoShadow : map_of_light[i];
  });
  return result;
}

RawArray<ShadeLight> prepareLights(const Scene& scene, const Camera& camera,
                                   std::span<const std::uint32_t> map_of_light) {
  return prepareLights(scene, spatialOrder(scene.lights), camera, map_of_light);
}

}  // namespace luciole
