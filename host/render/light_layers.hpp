#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "render/lighting.hpp"
#include "render/render.hpp"

// Layers that hold a part of a picture's light each, so that their sum is the picture: one for each group of
// lights and one for what no light gives, or one for each of Phong's terms. The picture's G-buffer is lit
// once for each, by the kernels that light it, with what isn't in the layer left out of lights and frame.
namespace luciole {

struct LightLayer {
  std::string name;                         ///< its channels are name + "R", "G" and "B"
  std::optional<std::uint32_t> group = {};  ///< whose lights it has; of none: see all_lights
  bool all_lights = false;                  ///< it has the lights of all groups
  bool light_ambient = true, diffuse = true, specular = true;  ///< what of these lights' colours
  bool ambient = false;                                        ///< the scene's ambient light
  bool emission = false;
  bool fog = false;         ///< the fog's own colour; all light is seen through the fog
  bool background = false;  ///< where nothing is seen
};

/// Layers of groups at most: more channels than any program reads.
inline constexpr std::size_t kMostLightGroups = 4096;

/// Whether the settings ask for such layers.
bool wantsLightLayers(const RenderSettings& settings);

/// The layers that the settings ask for: of RenderSettings::light_groups one for each group that a light is
/// in, in the scene's order, and one for the rest; then the parts among RenderSettings::aovs. O(lights).
/// Throws InputError for more than kMostLightGroups groups.
std::vector<LightLayer> lightLayers(const Scene& scene, const RenderSettings& settings);

/// A layer's lights, and its frame, which take the place of a Lighting's while the layer is lit.
struct LayerLighting {
  LightLayer layer;
  ShadeFrame frame{};
  LightArray host_lights;
  LightTree host_tree;
  std::vector<BeamLight> beam_lights;
  std::vector<std::uint32_t> beam_order;
  Buffer<const ShadeLight> lights;
  Buffer<const float> tree;
  Buffer<const BeamLight> beam_light_buffer;
};

/// The lighting of each of these layers of a picture, whose own is prepared. Lights keep their shadow maps
/// and the place of their samples.
std::vector<LayerLighting> prepareLayers(Device& device, const Scene& scene, const Lighting& lighting,
                                         std::vector<LightLayer> layers);

/// The features to light a layer with, of those that its picture has.
FeatureSet layerFeatures(FeatureSet features, const LightLayer& layer);

/// As lightGBuffer(), but the colours of a layer: planes r g b, and what lightGBuffer() has behind them.
Plane lightLayer(Device& device, const Scene& scene, Lighting& lighting, LayerLighting& layer,
                 const FeatureSet& features, const GBuffer& gbuffer, Stats& stats, Plane used = {});

}  // namespace luciole
