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

/// A channel of the picture, filled from a plane of the first sample.
struct Channel {
  std::string name;
  const float* plane;  ///< in the G-buffer's layout; null: filled in later
  float initial;       ///< value without a plane
};

/// The channels of the AOVs in the settings, but for parts of the light.
std::vector<Channel> aovChannels(FirstSample& sample, const RenderSettings& settings) {
  std::vector<Channel> channels;
  for (const Aov aov : settings.aovs) {
    const AovRow& row = aovRow(aov);
    const PlanePointers planes = row.planes ? row.planes(sample) : PlanePointers(row.channels.size());
    for (std::size_t c = 0; c < planes.size(); ++c)
      if (planes[c] || !row.planes) channels.push_back({row.channels[c], planes[c], row.initial});
  }
  return channels;
}

/// Calls visit(place in the G-buffer, pixel of the picture) for each pixel, in the order of the planes.
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

/// The factor from a sum over a pixel's samples to the exposed mean.
float scaleOf(const RenderSettings& settings) {
  return std::exp2(settings.exposure) / float(settings.samples);
}

/// The exposed bound of the mean of so many samples. sum: of their bounds. scale: scaleOf().
float boundOfMean(float sum, float mean, int samples, float scale) {
  // Each of n samples' products and sums rounds both colour and bound, and so do the factor and the product
  // with it: fewer than 2n + 3 roundings of 2⁻²⁴, of terms ≥ 0.
  const double rounding = (2 * samples + 3) * 0x1p-24, bound = double(sum) * scale;
  return finiteColor(float((1 + rounding) * bound + rounding * double(mean)));
}

}  // namespace

float finiteColor(float color) {
  constexpr float kLargest = std::numeric_limits<float>::max();
  return std::max(color < kLargest ? color : kLargest, -kLargest);
}

Image cutOut(Image picture, const glm::ivec2& first, const glm::ivec2& size) {
  if (size == glm::ivec2(picture.width, picture.height)) return picture;
  Image part{size.x, size.y, picture.channels, {}};
  const std::size_t step = picture.channels.size();
  part.pixels.reserve(std::size_t(size.x) * size.y * step);
  for (int y = first.y; y < first.y + size.y; ++y) {
    const auto row =
        picture.pixels.begin() + std::ptrdiff_t((std::size_t(y) * picture.width + first.x) * step);
    part.pixels.insert(part.pixels.end(), row, row + std::ptrdiff_t(std::size_t(size.x) * step));
  }
  return part;
}

bool boundsLayers(const RenderSettings& settings) {
  return settings.shade.light_error > 0 && settings.wants(Aov::kLightError);
}

std::size_t layerChannels(const RenderSettings& settings) { return boundsLayers(settings) ? 6 : 3; }

bool countsCovered(const RenderSettings& settings) {
  return settings.alpha || settings.wants(Aov::kShadingCount);
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
                   const std::vector<std::string>& light_layers, Image recycled) {
  FirstSample sample{gbuffer, first};
  const std::vector<Channel> aovs = aovChannels(sample, settings);
  Image image{gbuffer.width, gbuffer.height, {"R", "G", "B"}, std::move(recycled.pixels)};
  if (settings.alpha) image.channels.push_back("A");
  const std::size_t first_aov = image.channels.size();
  for (const Channel& aov : aovs) image.channels.push_back(aov.name);
  for (const std::string& layer : light_layers)
    for (const char* component : {"R", "G", "B"}) image.channels.push_back(layer + component);
  image.pixels.resize(std::size_t(image.width) * image.height * image.channels.size());
  if (aovs.empty()) return image;
  forEachPixel(gbuffer, image, [&](std::size_t place, float* pixel) {
    for (std::size_t c = 0; c < aovs.size(); ++c)
      pixel[first_aov + c] = aovs[c].plane ? aovs[c].plane[place] : aovs[c].initial;
  });
  return image;
}

void setLightLayer(const GBuffer& gbuffer, const PixelSums& sums, const RenderSettings& settings,
                   const LightLayer& of, std::size_t first_channel, Image& image) {
  const std::size_t n = gbuffer.pixels();
  RenderSettings unexposed = settings;
  if (of.illuminance) unexposed.exposure = 0;
  const float scale = scaleOf(unexposed);
  const bool has_bounds = boundsLayers(settings), is_bounded = !sums.light_error.empty();
  forEachPixel(gbuffer, image, [&](std::size_t place, float* pixel) {
    float* const layer = pixel + first_channel;
    for (std::size_t c = 0; c < 3; ++c) layer[c] = finiteColor(sums.color[place + c * n] * scale);
    for (std::size_t c = 0; c < 3 && has_bounds; ++c)
      layer[3 + c] =
          is_bounded ? boundOfMean(sums.light_error[place + c * n], layer[c], settings.samples, scale) : 0.0f;
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
  const std::optional<std::size_t> count_channel = channelOf(image, settings, Aov::kShadingCount);
  const bool is_bounded = !sums.light_error.empty();
  const std::optional<std::size_t> bound_channel = is_bounded ? channelOf(image, settings, Aov::kLightError)
                                                              : std::nullopt,
                                   proof_channel = is_bounded ? channelOf(image, settings, Aov::kLightProof)
                                                              : std::nullopt;
  const float scale = scaleOf(settings);
  forEachPixel(gbuffer, image, [&](std::size_t place, float* pixel) {
    for (int c = 0; c < 3; ++c) pixel[c] = finiteColor(sums.color[place + c * n] * scale);
    if (settings.alpha) pixel[3] = sums.covered[place] / float(settings.samples);
    for (int c = 0; c < 3 && bound_channel; ++c)
      pixel[*bound_channel + c] =
          boundOfMean(sums.light_error[place + c * n], pixel[c], settings.samples, scale);
    for (int c = 0; c < 3 && proof_channel; ++c) {
      const float width = sums.half_width.empty() ? 0.0f : sums.half_width[place + c * n],
                  bound = sums.light_error[place + c * n];
      pixel[*proof_channel + c] = bound > width ? 1 - width / bound : bound > 0 ? 0.0f : 1.0f;
    }
    if (count_channel) pixel[*count_channel] = shadings[place];
  });
}

}  // namespace luciole
