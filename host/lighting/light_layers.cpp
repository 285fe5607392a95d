#include "lighting/light_layers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <utility>

#include "image/light_names.hpp"
#include "lighting/bounded_lights.hpp"
#include "lighting/lighting.hpp"
#include "luciole/error.hpp"
#include "scene/light_groups.hpp"

namespace luciole {
namespace {

/// A part of a picture's light by its AOV.
struct LightPart {
  Aov aov;
  LightLayer layer;
};
std::vector<LightPart> lightParts() {
  const auto named = [](int part) { return std::string(kLightParts[part]); };
  return {
      {Aov::kAmbient,
       {.name = named(0), .all_lights = true, .diffuse = false, .specular = false, .ambient = true}},
      {Aov::kDiffuseLight, {.name = named(1), .all_lights = true, .light_ambient = false, .specular = false}},
      {Aov::kSpecularLight, {.name = named(2), .all_lights = true, .light_ambient = false, .diffuse = false}},
      {Aov::kEmission, {.name = named(3), .emission = true, .background = true}},
      {Aov::kFog, {.name = named(4), .fog = true}},
      {Aov::kIlluminance,
       {.name = "illuminance.",
        .all_lights = true,
        .light_ambient = false,
        .specular = false,
        .illuminance = true}},
  };
}

void darken(float4& color) { color.x = color.y = color.z = 0; }
void brighten(float4& color, float factor) {
  color.x *= factor;
  color.y *= factor;
  color.z *= factor;
}

/// The lights of a layer.
struct ChosenLights {
  std::vector<std::uint32_t> summed;  ///< their indices in the picture's set, ascending
  BoundedLights bounded;
};

/// The light set of a layer, but for bounded lights. summed: see ChosenLights.
LightSet layerLights(OpenedDevice& device, const Scene& scene, const LightSet& lights,
                     const std::vector<std::uint32_t>& summed, const LightLayer& layer) {
  LightSet set;
  set.frame = lights.frame;
  if (!layer.ambient) darken(set.frame.ambient);
  if (!layer.fog) darken(set.frame.fog_color);
  if (!layer.background) darken(set.frame.background);
  if (layer.background) set.sky = lights.sky;
  set.emission = layer.emission;
  if (layer.illuminance) set.frame.model = kPhongModel;  // whose diffuse light is N·L
  for (const std::uint32_t i : summed) {
    ShadeLight light = lights.lights[i];
    if (!layer.light_ambient) darken(light.ambient);
    if (!layer.diffuse) darken(light.diffuse);
    if (!layer.specular) darken(light.specular);
    if (layer.illuminance) brighten(light.diffuse, luxOfColor(scene.lights[lights.order[i]]));
    set.lights.push_back(light);
    set.order.push_back(lights.order[i]);
    if (!lights.beam_lights.empty()) set.beam_lights.push_back(lights.beam_lights[i]);
  }
  finishLightSet(device, set);
  set.luminaire_buffer = lights.luminaire_buffer;
  return set;
}

}  // namespace

bool wantsLightLayers(const RenderSettings& settings) {
  const std::vector<LightPart> parts = lightParts();
  return settings.light_groups || std::any_of(parts.begin(), parts.end(), [&](const LightPart& part) {
           return settings.wants(part.aov);
         });
}

std::vector<LightLayer> lightLayers(const Scene& scene, const RenderSettings& settings) {
  std::vector<LightLayer> layers;
  if (settings.light_groups) {
    std::vector<bool> has_lights(scene.light_groups.size());
    for (const Light& light : scene.lights) has_lights[light.group] = true;
    const auto groups = std::size_t(std::count(has_lights.begin(), has_lights.end(), true));
    if (groups > kMostLightGroups)
      throw InputError(fmt::format("{}: {} groups of lights, expected {} at most for a layer each",
                                   scene.name, groups, kMostLightGroups));
    for (std::uint32_t group = 0; group < has_lights.size(); ++group)
      if (has_lights[group])
        layers.push_back(
            {.name = std::string(kLightGroups) + scene.light_groups[group] + ".", .group = group});
    layers.push_back({.name = fmt::format("{}{}.", kLightGroups, kRestOfLight),
                      .ambient = true,
                      .emission = true,
                      .fog = true,
                      .background = true});
  }
  for (LightPart& part : lightParts())
    if (settings.wants(part.aov)) layers.push_back(std::move(part.layer));
  return layers;
}

std::vector<LitLayer> prepareLayers(OpenedDevice& device, const Scene& scene, const Camera& camera,
                                    const Lighting& lighting, const FeatureSet& features,
                                    const ShadeSettings& settings, std::vector<LightLayer> layers) {
  if (layers.empty()) return {};
  const LightSet& lights = lighting.lights;
  ChosenLights all{std::vector<std::uint32_t>(lights.lights.size()),
                   boundedLights(scene, features, settings)};
  std::iota(all.summed.begin(), all.summed.end(), 0u);
  ChosenLights nothing;
  nothing.bounded.shadows = all.bounded.shadows;
  std::vector<ChosenLights> in_groups(scene.light_groups.size(), nothing);
  const auto groupOf = [&](std::uint32_t light) -> ChosenLights& {
    return in_groups[scene.lights[light].group];
  };
  for (const std::uint32_t i : all.summed) groupOf(lights.order[i]).summed.push_back(i);
  for (const std::uint32_t light : all.bounded.clustered) groupOf(light).bounded.clustered.push_back(light);
  for (const std::uint32_t light : all.bounded.sampled) groupOf(light).bounded.sampled.push_back(light);
  for (const std::uint32_t light : all.bounded.directions) groupOf(light).bounded.directions.push_back(light);
  std::vector<LitLayer> prepared;
  for (LightLayer& layer : layers) {
    const ChosenLights& chosen = layer.all_lights ? all : layer.group ? in_groups[*layer.group] : nothing;
    LightSet set = layerLights(device, scene, lights, chosen.summed, layer);
    setBoundedLights(scene, camera, lighting.beams, features, chosen.bounded,
                     {layer.diffuse, layer.specular, layer.illuminance}, set);
    const FeatureSet needed = layerFeatures(features, layer);
    prepared.push_back({std::move(layer), needed, std::move(set)});
  }
  return prepared;
}

FeatureSet layerFeatures(FeatureSet features, const LightLayer& layer) {
  if (layer.illuminance) {
    features = features.without(featuresFor(kForFog, features));
    for (const Model model : kAllModels) features.set(featureOf(model), model == Model::kPhong);
    for (const Feature of_surfaces : {Feature::kUserModels, Feature::kMaterialModels, Feature::kTangents,
                                      Feature::kSpecular, Feature::kAmbient})
      features.set(of_surfaces, false);
  }
  // Light that comes with bounds reaches the shading kernels as light that surfaces emit.
  if (!layer.emission && !features.lightError()) features.set(Feature::kEmission, false);
  return features;
}

}  // namespace luciole
