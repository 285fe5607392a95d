#include "lighting/bounded_lights.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <glm/glm.hpp>
#include <utility>

namespace luciole {
namespace {

/// A colour of lights, or null: black.
using ColorOf = glm::vec3 Light::*;

glm::vec3 colorOf(const Light& light, ColorOf color) { return color ? light.*color : glm::vec3(0.0f); }

/// The clusters of these lights in the camera's view space.
LightClusters clustersOf(const Scene& scene, const Camera& camera, const std::vector<std::uint32_t>& chosen,
                         ColorOf color) {
  const glm::dmat4 world_to_view = worldToView(camera);
  std::vector<UnboundedLight> lights(chosen.size());
  tbb::parallel_for(std::size_t(0), chosen.size(), [&](std::size_t i) {
    const Light& light = scene.lights[chosen[i]];
    lights[i] = {glm::dvec3(world_to_view * glm::dvec4(light.position, 1)), glm::dvec3(colorOf(light, color)),
                 light.attenuation.z};
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
  set.diffuse = clustersOf(scene, camera, chosen, diffuse);
  if (highlights && !one_color) set.specular = clustersOf(scene, camera, chosen, specular);
  set.lights = chosen.size();
  return set;
}

SampledSet sampledSet(const Scene& scene, const BeamScene& beams, const std::vector<std::uint32_t>& chosen,
                      ClusterSet of_lights) {
  SampledSet set{std::move(of_lights), {}};
  const LightClusters& clusters = set.diffuse;
  set.places.resize(clusters.light_rows.size() / kLightFields);
  forEachSlot(clusters, [&](std::size_t slot, std::size_t i) {
    set.places[slot] = beamLight(scene.lights[chosen[clusters.order[i]]], true, beams).place;
  });
  return set;
}

}  // namespace

BoundedLights boundedLights(const Scene& scene, const FeatureSet& features, const ShadeSettings& settings) {
  BoundedLights chosen;
  if (!features.lightError()) return chosen;
  const UseConditions conditions = useConditions(settings);
  std::vector<LightUse> uses(scene.lights.size());
  tbb::parallel_for(std::size_t(0), uses.size(),
                    [&](std::size_t i) { uses[i] = lightUse(scene.lights[i], conditions); });
  for (std::uint32_t i = 0; i < uses.size(); ++i)
    if (!isSummed(uses[i], features))
      (uses[i] == LightUse::kClustered ? chosen.clustered : chosen.sampled).push_back(i);
  return chosen;
}

void setBoundedLights(const Scene& scene, const Camera& camera, const BeamScene& beams,
                      const FeatureSet& features, const BoundedLights& chosen, LightColors colors,
                      LightSet& set) {
  const bool highlights = features.has(Feature::kClusteredHighlights),
             sampled_highlights = features.has(Feature::kSampledHighlights);
  if (!chosen.clustered.empty() && (colors.diffuse || (colors.specular && highlights)))
    set.clusters = clusterSet(scene, camera, highlights, chosen.clustered, colors);
  if (!chosen.sampled.empty() && (colors.diffuse || (colors.specular && sampled_highlights)))
    set.samples = sampledSet(scene, beams, chosen.sampled,
                             clusterSet(scene, camera, sampled_highlights, chosen.sampled, colors));
}

}  // namespace luciole
