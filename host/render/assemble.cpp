#include "render/assemble.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "kernels/shared.h"
#include "raster/square.hpp"
#include "render/aov_table.hpp"

namespace luciole {
namespace {

/// A channel of the finished picture, and where its values are.
struct Layer {
  std::string name;
  const float* plane;  ///< in the G-buffer's layout; null: filled in later
  float otherwise;     ///< without a plane
};

/// World-space positions or normals and depths, from the view-space planes.
void fillWorldPlanes(FirstSample& sample) {
  const GBuffer& gbuffer = sample.gbuffer;
  const std::size_t n = gbuffer.pixels();
  sample.world_position.resize(3 * n);
  sample.world_normal.resize(3 * n);
  sample.depth.resize(n);
  const glm::dmat4& to_world = gbuffer.camera.camera_to_world;
  tbb::parallel_for(std::size_t(0), n, [&](std::size_t i) {
    const glm::dvec3 p(gbuffer.position[i], gbuffer.position[i + n], gbuffer.position[i + 2 * n]);
    const glm::dvec3 normal(gbuffer.normal[i], gbuffer.normal[i + n], gbuffer.normal[i + 2 * n]);
    const bool covered = std::isfinite(p.z);
    const glm::dvec3 world_p = covered ? glm::dvec3(to_world * glm::dvec4(p, 1)) : glm::dvec3(0);
    const glm::dvec3 world_n = glm::dmat3(to_world) * normal;
    for (int c = 0; c < 3; ++c) {
      sample.world_position[i + c * n] = float(world_p[c]);
      sample.world_normal[i + c * n] = float(world_n[c]);
    }
    sample.depth[i] = float(-p.z);
  });
}

/// The layers that the settings ask for, but parts of the light.
std::vector<Layer> layersOf(const FirstSample& sample, const RenderSettings& settings) {
  std::vector<Layer> layers;
  for (const Aov aov : settings.aovs) {
    const AovRow& row = aovRow(aov);
    const ChannelPlaces places = row.places ? row.places(sample) : ChannelPlaces(row.channels.size());
    for (std::size_t c = 0; c < places.size(); ++c)
      if (places[c] || !row.places) layers.push_back({row.channels[c], places[c], row.otherwise});
  }
  return layers;
}

/// Calls `visit(place in the G-buffer, pixel of the picture)` for each pixel, tile by tile, as they lie in
/// the planes.
template <class Visit>
void forEachPixel(const GBuffer& gbuffer, Image& image, Visit visit) {
  const int tiles_x = gbuffer.tiles_x;
  tbb::parallel_for(0, tiles_x * gbuffer.tiles_y, [&](int tile) {
    const glm::ivec2 first = glm::ivec2(tile % tiles_x, tile / tiles_x) * int(kTileSize);
    for (int i = 0; i < kTilePixels; ++i) {
      const int square = i / kSquarePixels, in_square = i % kSquarePixels;
      const int x = first.x + kSquareSize * kSquareLayout.x[square] + kSquareLayout.x[in_square];
      const int y = first.y + kSquareSize * kSquareLayout.y[square] + kSquareLayout.y[in_square];
      if (x < image.width && y < image.height)
        visit(std::size_t(tile) * kTilePixels + i,
              image.pixels.data() + (std::size_t(y) * image.width + x) * image.channels.size());
    }
  });
}

/// As finite_color() in the kernels: the sum of bright samples may overflow a float.
float finiteColor(float color) {
  constexpr float kLargest = std::numeric_limits<float>::max();
  return std::max(color < kLargest ? color : kLargest, -kLargest);
}

/// What sums over a pixel's samples are multiplied by.
float scaleOf(const RenderSettings& settings) {
  return std::exp2(settings.exposure) / float(settings.samples);
}

}  // namespace

bool countsCovered(const RenderSettings& settings) {
  return settings.alpha || settings.wants(Aov::kShadingCount);
}

bool wantsInWorld(const RenderSettings& settings) {
  return std::any_of(settings.aovs.begin(), settings.aovs.end(),
                     [](Aov aov) { return aovRow(aov).in_world; });
}

std::optional<std::size_t> channelOf(const Image& image, const RenderSettings& settings, Aov aov) {
  if (!settings.wants(aov)) return std::nullopt;
  return std::find(image.channels.begin(), image.channels.end(), aovRow(aov).channels.front()) -
         image.channels.begin();
}

std::size_t channelCount(const RenderSettings& settings, const PlaneSet& planes) {
  std::size_t count = settings.alpha ? 4 : 3;
  for (const Aov aov : settings.aovs)
    count += aov == Aov::kMaterial
                 ? (planes.specular ? 4 : 0) + (planes.ambient ? 3 : 0) + (planes.emission ? 3 : 0)
                 : aovRow(aov).channels.size();
  return count;
}

Image startPicture(const GBuffer& gbuffer, const LitPlanes& first, const RenderSettings& settings,
                   const std::vector<std::string>& light_layers, Image used) {
  FirstSample sample{gbuffer, first, {},
                     {},      {},    Plane(settings.wants(Aov::kShadow) ? gbuffer.pixels() : 0, 1.0f)};
  if (wantsInWorld(settings)) fillWorldPlanes(sample);
  const std::vector<Layer> layers = layersOf(sample, settings);
  Image image{gbuffer.width, gbuffer.height, {"R", "G", "B"}, std::move(used.pixels)};
  if (settings.alpha) image.channels.push_back("A");
  const std::size_t first_layer = image.channels.size();
  for (const Layer& layer : layers) image.channels.push_back(layer.name);
  for (const std::string& layer : light_layers)
    for (const char* component : {"R", "G", "B"}) image.channels.push_back(layer + component);
  image.pixels.resize(std::size_t(image.width) * image.height * image.channels.size());
  if (layers.empty()) return image;
  forEachPixel(gbuffer, image, [&](std::size_t place, float* pixel) {
    for (std::size_t c = 0; c < layers.size(); ++c)
      pixel[first_layer + c] = layers[c].plane ? layers[c].plane[place] : layers[c].otherwise;
  });
  return image;
}

void setLightLayer(const GBuffer& gbuffer, const Plane& sums, const RenderSettings& settings,
                   std::size_t first_channel, Image& image) {
  const std::size_t n = gbuffer.pixels();
  const float scale = scaleOf(settings);
  forEachPixel(gbuffer, image, [&](std::size_t place, float* pixel) {
    for (std::size_t c = 0; c < 3; ++c) pixel[first_channel + c] = finiteColor(sums[place + c * n] * scale);
  });
}

void countCovered(const GBuffer& gbuffer, Plane& covered) {
  const std::size_t n = gbuffer.pixels();
  covered.resize(n);
  tbb::parallel_for(std::size_t(0), n, [&](std::size_t i) {
    covered[i] += std::isfinite(gbuffer.position[i + 2 * n]) ? 1.0f : 0.0f;
  });
}

void setColors(const GBuffer& gbuffer, const PixelSums& sums, const RenderSettings& settings, Image& image) {
  const std::size_t n = gbuffer.pixels();
  const Plane& shadings = sums.shadings.empty() ? sums.covered : sums.shadings;
  const std::optional<std::size_t> counted = channelOf(image, settings, Aov::kShadingCount);
  const std::optional<std::size_t> bounded =
      sums.light_error.empty() ? std::nullopt : channelOf(image, settings, Aov::kLightError);
  const float scale = scaleOf(settings);
  // Each of n samples' products and sums rounds both colour and bound, and so do the factor and the product
  // with it: fewer than 2n + 3 roundings of 2⁻²⁴, of terms ≥ 0.
  const double rounding = (2 * settings.samples + 3) * 0x1p-24;
  forEachPixel(gbuffer, image, [&](std::size_t place, float* pixel) {
    for (int c = 0; c < 3; ++c) pixel[c] = finiteColor(sums.color[place + c * n] * scale);
    if (settings.alpha) pixel[3] = sums.covered[place] / float(settings.samples);
    for (int c = 0; c < 3 && bounded; ++c) {
      const double bound = double(sums.light_error[place + c * n]) * scale;
      pixel[*bounded + c] = finiteColor(float((1 + rounding) * bound + rounding * double(pixel[c])));
    }
    if (counted) pixel[*counted] = shadings[place];
  });
}

}  // namespace luciole
