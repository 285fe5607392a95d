#include "render/memory.hpp"

#include <algorithm>
#include <cmath>

#include "base/machine_memory.hpp"
#include "kernels/shared.h"
#include "lights/light_use.hpp"
#include "raster/bins.hpp"
#include "render/aov_table.hpp"
#include "render/assemble.hpp"
#include "render/screens.hpp"

namespace luciole {
namespace {

std::size_t roundUp(std::size_t value, std::size_t step) { return (value + step - 1) / step * step; }

}  // namespace

std::size_t bytesPerPixel(const Scene& scene, const RenderSettings& settings, const PicturePlan& plan) {
  const PlaneSet& planes = plan.planes;
  const FeatureSet& features = plan.pixels;
  // Light of clusters adds 3 planes each of light, bounds and their sum; sampled light 3 of half widths.
  const std::size_t bounded = (features.lightError() ? 9 : 0) + (features.sampledLight() ? 3 : 0);
  const std::size_t gbuffer = 9 + bounded + (planes.specular ? 4 : 0) + (planes.ambient ? 3 : 0) +
                              (planes.emission ? 3 : 0) + (planes.geometric_normal ? 1 : 0) +
                              (planes.unbent_normal ? 1 : 0) + (planes.lift ? 1 : 0) +
                              (planes.model ? 1 : 0) + (planes.tangent ? 1 : 0) + (planes.uv ? 2 : 0) +
                              (planes.object ? 1 : 0) + (planes.material ? 1 : 0);
  const std::size_t lit = features.has(Feature::kOutputShadow) ? 4 : 3;
  const std::size_t counted = settings.count_lights || settings.wants(Aov::kLightCount) ? 1 : 0;
  const std::size_t light_layers = layerChannels(settings) * plan.layers.size();
  const std::size_t channels = channelCount(settings, planes) + light_layers;
  // Colours and counts are on the device and on the host. The picture of the band before still exists, and
  // from the second sample on the sums.
  const std::size_t covered = countsCovered(settings) ? 1 : 0;
  const std::size_t sums = settings.samples > 1 ? lit + covered + light_layers : 0;
  const std::size_t screens = screenFloats(plan.screens, settings.samples);
  const std::size_t lighting = gbuffer + 2 * lit + 2 * counted + channels + sums + screens;
  std::size_t assembling = gbuffer + lit + counted + channels + covered;
  for (const Aov aov : settings.aovs) assembling += std::size_t(aovRow(aov).computed_floats);
  if (settings.wants(Aov::kListLength)) ++assembling;
  const UseConditions conditions = useConditions(plan.shade);
  const std::size_t everywhere =
      std::count_if(scene.lights.begin(), scene.lights.end(), [&](const Light& light) {
        return !std::isfinite(light.range) && isSummed(lightUse(light, conditions), features);
      });
  const std::size_t lists = features.has(Feature::kLightLists)
                                ? kListBytesPerPixel + sizeof(ListEntry) * everywhere / kTilePixels
                                : 0;
  // Counting lights in range needs lists of its own. Exact shadows take a group of words for each entry.
  // Lights with a size take ten: two more, and the shares found by rays, eight if rays decide a fourth of the
  // pairs.
  const std::size_t words = (features.has(Feature::kExact) ? 1 : 0) + (features.has(Feature::kSoftExact) ? 10
                                                                       : features.has(Feature::kHoles)   ? 1
                                                                                                         : 0);
  const std::size_t all_lists =
      lists * (1 + counted) + lists * words * (kPairWords * sizeof(uint) / sizeof(ListEntry));
  if (!plan.shares_samples) return sizeof(float) * std::max(lighting, assembling) + all_lists;
  // Sums of `covered` and `shadings` beside colours, and a pass of points with as many planes as pixels have.
  const std::size_t first =
      std::max(gbuffer + 2 * lit + 2 * counted + channels + light_layers, assembling + 2);
  const std::size_t further =
      3 + 2 + channels + light_layers + (gbuffer + 2 * lit + 2 * counted) / kPixelsAPoint + 1;
  const std::size_t labels = sizeof(std::uint32_t) * std::size_t(settings.samples);
  return sizeof(float) * std::max(first, further) + kPointBytesPerPixel + labels + all_lists;
}

bool sharesSamples(const RenderSettings& settings) {
  return settings.samples > 1 && settings.sample_shading == SampleShading::kShared &&
         settings.screens.empty();
}

std::size_t pointsAPass(std::size_t pixels) { return std::max<std::size_t>(pixels / kPixelsAPoint, 1 << 16); }

int bandHeight(glm::ivec2 size, std::size_t bytes_per_pixel) {
  const double budget = std::min(double(kBandBytes), memoryRoom().bytes / 4);
  const std::size_t row = roundUp(std::size_t(size.x), kTileSize) * bytes_per_pixel;
  const std::size_t rows = std::max<std::size_t>(std::size_t(budget) / row / kBinSize, 1) * kBinSize;
  const std::size_t bands = (std::size_t(size.y) + rows - 1) / rows;
  return int(roundUp((std::size_t(size.y) + bands - 1) / bands, kBinSize));
}

}  // namespace luciole
