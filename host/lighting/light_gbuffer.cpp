#include "lighting/light_gbuffer.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "lighting/count_lights.hpp"
#include "lighting/stages.hpp"
#include "shade/seen_rounding.hpp"

namespace luciole {
namespace {

/// Whether one kernel culls and shades, without light lists in memory. It does if nothing else reads the
/// lists and there are many lights. With few, lists are faster: four rows of pixels are lit together. A
/// device of single lanes (a GPU) has far more threads than a picture has blocks of tiles.
bool shadesByTiles(const OpenedDevice& device, const Lighting& lighting, const LightPass& pass) {
  const FeatureSet& features = pass.features;
  return features.has(Feature::kLightLists) && features.has(Feature::kLongSums) && !features.shadows() &&
         !pass.counts.list_length && lighting.group_log2 == 4 && device.description.lanes > 1;
}

/// Draws the texels of shadow maps that the points look up, unless earlier points did.
void drawNeededMaps(const StageInput& input, MapScene& maps, Stats& stats) {
  if (maps.host.maps.empty()) return;
  const auto needed = timed(stats, Stage::kFindShadowTexels, [&] { return findTexels(input); });
  timed(stats, Stage::kShadowMaps, [&] { drawMaps(input.device, input.scene, needed, maps); });
}

/// Computes the exact shadows: by beams, and by rays for the pairs that beams leave undecided.
void computeExactShadows(const StageInput& input, LitPlanes& lit, Stats& stats) {
  lit.pairs = timed(stats, Stage::kBeamShadows, [&] { return decideBeams(input); });
  if (lit.pairs.counts.count > 0)
    lit.traced = timed(stats, Stage::kShadowRays, [&] { return traceUnsurePairs(input, lit.pairs); });
  // Without lights of a size all bits are decided now. With them shading reads the shares of unsure pairs.
  if (!input.pass.features.has(Feature::kSoftExact)) lit.pairs.unsure = {};
}

/// The bytes of the device's buffers for this G-buffer.
std::size_t bytesOf(const StageInput& input, const BoundedLight& bounded, const LitPlanes& lit) {
  const std::size_t floats =
      bounded.light.size() + lit.half_width.size() + lit.light_error.size() + lit.color.size();
  const std::size_t words =
      lit.pairs.lit.count + lit.pairs.unsure.count + lit.pairs.first_share.count + lit.pairs.shares.count;
  return input.points.bytes + bytesOf(input.pass.lights) + input.lists.bytes + floats * sizeof(float) +
         words * sizeof(uint) + input.lighting.maps.host.texels.size() * sizeof(ShadowTexel);
}

}  // namespace

FeatureSet programFor(const OpenedDevice& device, const FeatureSet& features) {
  return device.lights_generally && isGeneral(features) ? generalFeatures() : features;
}

LitPlanes lightGBuffer(OpenedDevice& device, const Scene& scene, Lighting& lighting, LightPass pass,
                       Stats& stats) {
  const FeatureSet& features = pass.features;
  const bool by_tiles = shadesByTiles(device, lighting, pass);
  const bool by_lists = features.has(Feature::kLightLists) && !by_tiles;
  const LightLists no_lists;
  LitPlanes lit;
  BoundedLight bounded;
  const FeatureSet compiled = programFor(device, features);
  Points points = pointsOnDevice(device, pass.gbuffer, features, compiled, lighting.unlit);
  const StageInput input{
      device, scene, lighting, pass, compiled, points, by_lists ? lighting.lists : no_lists};
  if (by_lists) timed(stats, Stage::kCull, [&] { cullLights(input, lighting.lists); });
  if (features.shadowMaps()) drawNeededMaps(input, lighting.maps, stats);
  if (features.has(Feature::kExact) && lighting.beams.tree) computeExactShadows(input, lit, stats);
  ShadeFrame frame = pass.lights.frame;
  // What a layer, or light at vertices, leaves out, the general program leaves out, too.
  if (!seesFog(features)) frame.fog_mode = kNoFog;
  frame.plane_stride = static_cast<uint>(points.stride);
  frame.texel_count = static_cast<uint>(std::max<std::size_t>(lighting.maps.host.texels.size(), 1));
  if (features.lightError()) {
    bounded = timed(stats, Stage::kClusteredLight, [&] { return sumClusters(input, frame); });
    if (pass.lights.samples.lights + pass.lights.directions.lights > 0)
      timed(stats, Stage::kSampledLight, [&] { sampleLights(input, frame, bounded); });
    points.buffers.emission = borrowed(device, bounded.light);
  }
  lit.color = std::move(pass.recycled);
  lit.color.resize(points.stride * (features.has(Feature::kOutputShadow) ? 4 : 3));
  ShadedBuffers out{borrowedForOutput(device, lit.color), {}};
  std::vector<uint> faulty_pixels(features.has(Feature::kUserModels) ? 1 : 0);
  if (!faulty_pixels.empty()) {
    out.faulty_pixels = makeBuffer<uint>(device, 1);
    fill(device, out.faulty_pixels, 0);
  }
  TileCounts of_tiles{input.lists.entries, 0};
  timed(stats, Stage::kShade, [&] {
    if (by_tiles)
      of_tiles = shadeByTiles(input, frame, out);
    else
      shadeByLists(input, frame, lit.pairs, out);
  });
  timed(stats, Stage::kReadBack, [&] {
    download(device, out.image, lit.color);
    if (!faulty_pixels.empty()) download(device, out.faulty_pixels, faulty_pixels);
  });
  lit.faulty_pixels = faulty_pixels.empty() ? 0 : faulty_pixels[0];
  lit.list_entries = of_tiles.entries;
  lit.evaluated = of_tiles.pairs;
  lit.clustered = bounded.cluster_counts;
  lit.sampled = bounded.sample_counts;
  lit.light_error = std::move(bounded.bound);
  lit.half_width = std::move(bounded.half_width);
  if (features.lightError() || lighting.vertex_error)
    boundVisibleLight(pass.gbuffer, frame, features,
                      bounded.light.empty() ? pass.gbuffer.emission : bounded.light, lit.color,
                      lighting.vertex_error ? std::optional(lighting.vertex_error->bound) : std::nullopt,
                      lit.light_error);
  if (lighting.vertex_error && lighting.vertex_error->half_width != glm::vec3(0.0f)) {
    lit.half_width.resize(lit.light_error.size());
    for (std::size_t i = 0; i < lit.half_width.size(); ++i)
      lit.half_width[i] =
          std::min(lighting.vertex_error->half_width[int(i / pass.gbuffer.pixels())], lit.light_error[i]);
  }
  PixelCounts missing = pass.counts;
  missing.evaluated &= !by_tiles;
  if (missing.in_range || missing.evaluated || missing.list_length)
    timed(stats, Stage::kCountLights, [&] { countLights(input, missing, lighting.lists_in_range, lit); });
  stats.device_bytes = std::max(stats.device_bytes, bytesOf(input, bounded, lit));
  return lit;
}

}  // namespace luciole
