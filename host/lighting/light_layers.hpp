#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "lights/light_set.hpp"
#include "luciole/scene.hpp"
#include "luciole/settings.hpp"
#include "shade/features.hpp"

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

/// A layer, and what it is lit by.
struct LitLayer {
  LightLayer layer;
  FeatureSet features;
  LightSet lights;
};

/// These layers of a picture whose lighting is prepared. features: of the picture. Lights keep their shadow
/// maps and the place of their samples.
std::vector<LitLayer> prepareLayers(OpenedDevice& device, const Scene& scene, const LightSet& lights,
                                    const FeatureSet& features, std::vector<LightLayer> layers);

/// The features to light a layer with, of those that its picture has.
FeatureSet layerFeatures(FeatureSet features, const LightLayer& layer);

}  // namespace luciole
