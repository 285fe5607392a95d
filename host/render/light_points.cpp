#include "render/light_points.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "image/light_names.hpp"
#include "render/assemble.hpp"

namespace luciole {

/// White surfaces in the same places.
static GBuffer whitened(const GBuffer& gbuffer) {
  GBuffer white = gbuffer;
  std::fill(white.diffuse.begin(), white.diffuse.end(), 1.0f);
  return white;
}

void lightPoints(ReadyPicture& picture, const FeatureSet& features, PointLister& lister) {
  const auto light = [&](const LightSet& lights, const FeatureSet& of_lights, const PixelCounts& counts,
                         const GBuffer& points) {
    return lightGBuffer(picture.device, picture.scene, picture.lighting,
                        {lights, of_lights, points, counts, std::exchange(lister.recycled, {})},
                        picture.stats);
  };
  while (lister.next()) {
    lister.take(light(picture.lighting.lights, features, lister.counts, *lister.gbuffer));
    for (std::size_t i = 0; i < picture.layers.size(); ++i) {
      const LitLayer& layer = picture.layers[i];
      std::optional<GBuffer> white;
      if (layer.layer.illuminance) white = whitened(*lister.gbuffer);
      LitPlanes lit = light(layer.lights, layer.features, {}, white ? *white : *lister.gbuffer);
      if (!boundsLayers(picture.settings)) lit.light_error = {};
      lister.takeLayer(i, {.color = std::move(lit.color), .light_error = std::move(lit.light_error)});
    }
  }
}

PixelCounts wantedCounts(const RenderSettings& settings, int sample) {
  return {.evaluated = settings.count_lights,
          .in_range = settings.count_lights || (sample == 0 && settings.wants(Aov::kLightCount)),
          .list_length = sample == 0 && settings.wants(Aov::kListLength)};
}

std::vector<std::string> layerNames(const ReadyPicture& picture) {
  std::vector<std::string> names;
  for (const LitLayer& layer : picture.layers) {
    names.push_back(layer.layer.name);
    if (boundsLayers(picture.settings)) names.push_back(layer.layer.name + std::string(kLayerBounds));
  }
  return names;
}

std::size_t channelOfLayer(const ReadyPicture& picture, const Image& image, std::size_t layer) {
  return image.channels.size() - layerChannels(picture.settings) * (picture.layers.size() - layer);
}

}  // namespace luciole
