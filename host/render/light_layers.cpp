#include "render/light_layers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <span>
#include <utility>

#include "base/error.hpp"
#include "culling/light_tree.hpp"
#include "image/light_names.hpp"
#include "render/assemble.hpp"
#include "scene/light_groups.hpp"

namespace luciole {
namespace {

/// The parts that the settings may ask for, named as kLightParts has them.
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
  };
}

/// Swaps what the two have in common.
void exchange(LayerLighting& layer, Lighting& lighting) {
  std::swap(layer.frame, lighting.frame);
  std::swap(layer.host_lights, lighting.host_lights);
  std::swap(layer.host_tree, lighting.host_tree);
  std::swap(layer.beam_lights, lighting.beams.lights);
  std::swap(layer.beam_order, lighting.beams.order);
  std::swap(layer.lights, lighting.lights);
  std::swap(layer.tree, lighting.tree);
  std::swap(layer.beam_light_buffer, lighting.beams.light_buffer);
}

/// While it exists, `lighting` has the layer's lights. They are given back also if something is thrown: where
/// the device runs out of memory, the picture goes on in smaller bands.
class LitByLayer {
 public:
  LitByLayer(LayerLighting& layer, Lighting& lighting) : of_layer(layer), of_picture(lighting) {
    exchange(of_layer, of_picture);
  }
  ~LitByLayer() { exchange(of_layer, of_picture); }
  LitByLayer(const LitByLayer&) = delete;
  LitByLayer& operator=(const LitByLayer&) = delete;

 private:
  LayerLighting& of_layer;
  Lighting& of_picture;
};

void darken(float4& color) { color.x = color.y = color.z = 0; }

/// lights: those of the layer, by their places in `lighting`, in its order.
LayerLighting prepareLayer(Device& device, const Lighting& lighting, std::span<const std::uint32_t> lights,
                           LightLayer layer) {
  LayerLighting result;
  result.frame = lighting.frame;
  if (!layer.ambient) darken(result.frame.ambient);
  if (!layer.fog) darken(result.frame.fog_color);
  if (!layer.background) darken(result.frame.background);
  const bool has_beams = !lighting.beams.lights.empty();
  for (const std::uint32_t i : lights) {
    ShadeLight light = lighting.host_lights[i];
    if (!layer.light_ambient) darken(light.ambient);
    if (!layer.diffuse) darken(light.diffuse);
    if (!layer.specular) darken(light.specular);
    result.host_lights.push_back(light);
    if (!has_beams) continue;
    result.beam_lights.push_back(lighting.beams.lights[i]);
    result.beam_order.push_back(lighting.light_order[i]);
  }
  result.frame.light_count = static_cast<uint>(result.host_lights.size());
  result.host_tree = buildLightTree(result.host_lights);
  result.lights = borrowed(device, result.host_lights);
  result.tree = borrowed(device, result.host_tree.planes);
  result.beam_light_buffer = borrowed(device, result.beam_lights);
  result.layer = std::move(layer);
  return result;
}

}  // namespace

bool wantsLightLayers(const RenderSettings& settings) {
  const std::vector<LightPart> parts = lightParts();
  return settings.light_groups || std::any_of(parts.begin(), parts.end(), [&](const LightPart& part) {
           return wants(settings, part.aov);
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
    if (wants(settings, part.aov)) layers.push_back(std::move(part.layer));
  return layers;
}

std::vector<LayerLighting> prepareLayers(Device& device, const Scene& scene, const Lighting& lighting,
                                         std::vector<LightLayer> layers) {
  std::vector<std::uint32_t> all(lighting.host_lights.size());
  std::iota(all.begin(), all.end(), 0u);
  std::vector<std::vector<std::uint32_t>> in_groups(scene.light_groups.size());
  for (const std::uint32_t i : all) in_groups[scene.lights[lighting.light_order[i]].group].push_back(i);
  std::vector<LayerLighting> prepared;
  prepared.reserve(layers.size());
  for (LightLayer& layer : layers) {
    std::span<const std::uint32_t> lights;
    if (layer.all_lights) lights = all;
    if (layer.group) lights = in_groups[*layer.group];
    prepared.push_back(prepareLayer(device, lighting, lights, std::move(layer)));
  }
  return prepared;
}

FeatureSet layerFeatures(FeatureSet features, const LightLayer& layer) {
  if (!layer.emission) features.set(Feature::kEmission, false);
  return features;
}

Plane lightLayer(Device& device, const Scene& scene, Lighting& lighting, LayerLighting& layer,
                 const FeatureSet& features, const GBuffer& gbuffer, Stats& stats, Plane used) {
  const LitByLayer lit_by_layer(layer, lighting);
  return lightGBuffer(device, scene, lighting, layerFeatures(features, layer.layer), gbuffer, {}, stats,
                      std::move(used))
      .color;
}

}  // namespace luciole
