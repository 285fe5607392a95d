#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "lights/light_set.hpp"
#include "luciole/scene.hpp"
#include "luciole/settings.hpp"
#include "shade/features.hpp"

// Layers of light, whose sum is the picture: one for each group of lights and one for the rest, or one for
// each of Phong's terms. Each is lit by the picture's kernels, with the colours that aren't in the layer set
// to black.
namespace luciole {

struct Lighting;

struct LightLayer {
  std::string name;                         ///< its channels are name + "R", "G" and "B"
  std::optional<std::uint32_t> group = {};  ///< the group of its lights; empty: none, or all_lights
  bool all_lights = false;                  ///< it has the lights of all groups
  bool light_ambient = true, diffuse = true, specular = true;  ///< which colours of its lights it has
  bool ambient = false;                                        ///< the scene's ambient light
  bool emission = false;
  bool illuminance = false;  ///< what surfaces get of it, as if they were white and there was no fog
  bool fog = false;          ///< the fog's own colour; all light is seen through the fog
  bool background = false;   ///< Scene::background, or the environment
};

/// The most layers of groups.
inline constexpr std::size_t kMostLightGroups = 4096;

/// Whether the settings ask for such layers.
bool wantsLightLayers(const RenderSettings& settings);

/// The layers that the settings ask for: of RenderSettings::light_groups one for each group that a light is
/// in, in the scene's order, and one for the rest; then the parts among RenderSettings::aovs. O(lights).
/// Throws InputError for more than kMostLightGroups groups.
std::vector<LightLayer> lightLayers(const Scene& scene, const RenderSettings& settings);

/// A layer, its program's features and its lights.
struct LitLayer {
  LightLayer layer;
  FeatureSet features;
  LightSet lights;
};

/// Prepares layers of a picture. lighting, features, settings: the picture's. Lights keep their shadow maps
/// and the pattern of their soft shadows' samples. Those that aren't summed by themselves in the picture
/// aren't in a layer either, few though they may be there.
std::vector<LitLayer> prepareLayers(OpenedDevice& device, const Scene& scene, const Camera& camera,
                                    const Lighting& lighting, const FeatureSet& features,
                                    const ShadeSettings& settings, std::vector<LightLayer> layers);

/// The features of a layer's program, of a picture with these features.
FeatureSet layerFeatures(FeatureSet features, const LightLayer& layer);

}  // namespace luciole
