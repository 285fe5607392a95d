#include "lighting/bounded_lights.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <glm/glm.hpp>
#include <utility>

#include "kernels/sampled/sampled_light.h"

namespace luciole {
namespace {

/// A colour of lights, or null: black.
using ColorOf = glm::vec3 Light::*;

glm::vec3 colorOf(const Light& light, ColorOf color) { return color ? light.*color : glm::vec3(0.0f); }

/// The clusters of these lights in the camera's view space.
LightClusters clustersOf(const Scene& scene, const Camera& camera, const std::vector<std::uint32_t>& chosen,
                         ColorOf color, bool lux) {
  const glm::dmat4 world_to_view = worldToView(camera);
  const glm::dmat3 rotation(world_to_view);
  std::vector<UnboundedLight> lights(chosen.size());
  tbb::parallel_for(std::size_t(0), chosen.size(), [&](std::size_t i) {
    const Light& light = scene.lights[chosen[i]];
    const bool directional = light.kind == LightKind::kDirectional;
    lights[i] = {directional ? -(rotation * light.direction)
                             : glm::dvec3(world_to_view * glm::dvec4(light.position, 1)),
                 double(lux ? luxOfColor(light) : 1.0f) * glm::dvec3(colorOf(light, color)),
                 directional ? 1.0 : double(light.attenuation.z)};
  });
  return buildLightClusters(lights);
}

/// highlights: surfaces have specular colours.
ClusterSet clusterSet(const Scene& scene, const Camera& camera, bool highlights,
                      const std::vector<std::uint32_t>& chosen, LightColors colors) {
  const ColorOf diffuse = colors.diffuse ? &Light::diffuse : nullptr,
                specular = colors.specular ? &Light::specular : nullptr;
  const bool one_color = std::all_of(chosen.begin(), chosen.end(), [&](std::uint32_t light) {
    return colorOf(scene.lights[light], diffuse) == colorOf(scene.lights[light], specular);
  });
  ClusterSet set;
  set.diffuse = clustersOf(scene, camera, chosen, diffuse, colors.lux);
  if (highlights && !one_color) set.specular = clustersOf(scene, camera, chosen, specular, false);
  set.lights = chosen.size();
  return set;
}

/// shadows: lights that are marked so cast them.
SampledSet sampledSet(const Scene& scene, const Camera& camera, const BeamScene& beams,
                      const FeatureSet& features, const std::vector<std::uint32_t>& chosen, bool shadows,
                      ClusterSet of_lights) {
  constexpr std::size_t kRowFloats = std::size_t(kLobeFields) * kClusterSlots;
  SampledSet set{std::move(of_lights), {}, {}, 0};
  const LightClusters& clusters = set.diffuse;
  const std::size_t slots = clusters.light_rows.size() / kLightFields;
  set.places.resize(slots);
  if (features.has(Feature::kSampledLobes) || features.has(Feature::kWideHighlights))
    set.lobes.resize(slots / kClusterSlots * kRowFloats);
  std::fill(set.lobes.begin(), set.lobes.end(), 0.0f);
  const glm::dmat3 rotation(worldToView(camera));
  forEachSlot(clusters, [&](std::size_t slot, std::size_t i) {
    const Light& light = scene.lights[chosen[clusters.order[i]]];
    set.places[slot] = beamLight(light, true, beams).place;
    if (!(light.shadow && shadows)) set.places[slot].w = kNoRay;
    if (set.lobes.empty()) return;
    float* row = &set.lobes[slot / kClusterSlots * kRowFloats + slot % kClusterSlots];
    const auto field = [row](std::size_t number) -> float& { return row[number * kClusterSlots]; };
    const bool is_lobe = light.kind == LightKind::kSpot;
    const glm::vec3 axis = is_lobe ? glm::vec3(rotation * light.direction) : glm::vec3(0.0f);
    for (std::size_t k = 0; k < 3; ++k) field(kLobeAxis + k) = axis[int(k)];
    field(kLobeRound) = is_lobe ? 0.0f : 1.0f;
    float& cell = field(kLobeCell);
    cell = light.kind == LightKind::kDirectional ? light.cell : light.cell / light.attenuation.z;
    set.largest_cell = std::max(set.largest_cell, cell);
  });
  return set;
}

}  // namespace

BoundedLights boundedLights(const Scene& scene, const FeatureSet& features, const ShadeSettings& settings) {
  BoundedLights chosen;
  chosen.shadows = settings.shadows != ShadowMethod::kOff;
  if (!features.lightError()) return chosen;
  const UseConditions conditions = useConditions(settings);
  std::vector<LightUse> uses(scene.lights.size());
  tbb::parallel_for(std::size_t(0), uses.size(),
                    [&](std::size_t i) { uses[i] = lightUse(scene.lights[i], conditions); });
  for (std::uint32_t i = 0; i < uses.size(); ++i)
    if (!isSummed(uses[i], features))
      (uses[i] == LightUse::kClustered ? chosen.clustered
       : uses[i] == LightUse::kSampled ? chosen.sampled
                                       : chosen.directions)
          .push_back(i);
  return chosen;
}

void setBoundedLights(const Scene& scene, const Camera& camera, const BeamScene& beams,
                      const FeatureSet& features, const BoundedLights& chosen, LightColors colors,
                      LightSet& set) {
  const bool highlights = features.has(Feature::kClusteredHighlights),
             sampled_highlights = features.has(Feature::kSampledHighlights);
  if (!chosen.clustered.empty() && (colors.diffuse || (colors.specular && highlights)))
    set.clusters = clusterSet(scene, camera, highlights, chosen.clustered, colors);
  if (!colors.diffuse && !(colors.specular && sampled_highlights)) return;
  const auto samplesOf = [&](const std::vector<std::uint32_t>& lights) {
    return sampledSet(scene, camera, beams, features, lights, chosen.shadows,
                      clusterSet(scene, camera, sampled_highlights, lights, colors));
  };
  if (!chosen.sampled.empty()) set.samples = samplesOf(chosen.sampled);
  if (!chosen.directions.empty()) set.directions = samplesOf(chosen.directions);
}

}  // namespace luciole
