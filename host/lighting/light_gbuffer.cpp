#include "lighting/light_gbuffer.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "lighting/count_lights.hpp"
#include "lighting/stages.hpp"
#include "shade/seen_rounding.hpp"

namespace luciole {
namespace {

/// Whether culling and shading go together, without lists in memory: where nothing else reads them and there
/// are many lights. A few are faster by lists, whose rows of pixels are lit four side by side. A device of
/// single lanes has far more threads than a picture has blocks of tiles.
bool shadesByTiles(const OpenedDevice& device, const Lighting& lighting, const LightPass& pass) {
  const FeatureSet& features = pass.features;
  return features.has(Feature::kLightLists) && features.has(Feature::kLongSums) && !features.shadows() &&
         !pass.counts.list_length && lighting.group_log2 == 4 && device.description.lanes > 1;
}

/// Shadows of the lights that have maps. What of these is drawn stays drawn.
void castByMaps(const StageInput& input, MapScene& maps, Stats& stats) {
  if (maps.host.maps.empty()) return;
  const auto needed = timed(stats, Stage::kFindShadowTexels, [&] { return findTexels(input); });
  timed(stats, Stage::kShadowMaps, [&] { drawMaps(input.device, input.scene, needed, maps); });
}

/// Shadows of the lights that have none.
void castByBeams(const StageInput& input, LitPlanes& lit, Stats& stats) {
  lit.pairs = timed(stats, Stage::kBeamShadows, [&] { return decideBeams(input); });
  if (!lit.pairs.unsure.empty())
    lit.traced = timed(stats, Stage::kShadowRays, [&] { return traceUnsurePairs(input, lit.pairs); });
  // But for lights of a size rays have set the bits of those that were unsure.
  if (!input.pass.features.has(Feature::kSoftExact)) lit.pairs.unsure = {};
}

/// The bytes that this G-buffer took on the device.
std::size_t bytesOf(const StageInput& input, const ClusterLight& clusters, const LitPlanes& lit) {
  const std::size_t floats = clusters.light.size() + lit.light_error.size() + lit.color.size();
  const std::size_t words =
      lit.pairs.lit.size() + lit.pairs.unsure.size() + lit.pairs.first_share.size() + lit.pairs.shares.size();
  return input.points.bytes + bytesOf(input.pass.lights) + input.lists.bytes + floats * sizeof(float) +
         words * sizeof(uint) + input.lighting.maps.host.texels.size() * sizeof(ShadowTexel);
}

}  // namespace

LitPlanes lightGBuffer(OpenedDevice& device, const Scene& scene, Lighting& lighting, LightPass pass,
                       Stats& stats) {
  const FeatureSet& features = pass.features;
  const bool by_tiles = shadesByTiles(device, lighting, pass);
  const bool by_lists = features.has(Feature::kLightLists) && !by_tiles;
  const LightLists no_lists;
  LitPlanes lit;
  ClusterLight clusters;
  Points points = pointsOnDevice(device, pass.gbuffer, features, lighting.unlit);
  const StageInput input{device, scene, lighting, pass, points, by_lists ? lighting.lists : no_lists};
  if (by_lists) timed(stats, Stage::kCull, [&] { cullLights(input, lighting.lists); });
  if (features.shadowMaps()) castByMaps(input, lighting.maps, stats);
  if (features.has(Feature::kExact)) castByBeams(input, lit, stats);
  // Kept to the end: where a buffer is made in the place of one that is gone, Oclgrind takes it for
  // unwritten.
  const PairBuffers pairs = borrowPairs(device, lit.pairs);
  ShadeFrame frame = pass.lights.frame;
  frame.plane_stride = static_cast<uint>(points.stride);
  frame.texel_count = static_cast<uint>(std::max<std::size_t>(lighting.maps.host.texels.size(), 1));
  if (features.has(Feature::kClusteredLights)) {
    clusters = timed(stats, Stage::kClusteredLight, [&] { return sumClusters(input, frame); });
    points.buffers.emission = borrowed(device, clusters.light);
  }
  lit.color = std::move(pass.recycled);
  lit.color.resize(points.stride * (features.has(Feature::kOutputShadow) ? 4 : 3));
  const Buffer<float> image = borrowedForOutput(device, lit.color);
  TileCounts of_tiles{input.lists.entries, 0};
  timed(stats, Stage::kShade, [&] {
    if (by_tiles)
      of_tiles = shadeByTiles(input, frame, image);
    else
      shadeByLists(input, frame, pairs, image);
  });
  timed(stats, Stage::kReadBack, [&] { download(device, image, lit.color); });
  lit.list_entries = of_tiles.entries;
  lit.evaluated = of_tiles.pairs;
  lit.clustered = clusters.counts;
  lit.light_error = std::move(clusters.bound);
  if (features.has(Feature::kClusteredLights) || lighting.vertex_error)
    boundVisibleLight(pass.gbuffer, frame, features,
                      clusters.light.empty() ? pass.gbuffer.emission : clusters.light, lit.color,
                      lighting.vertex_error, lit.light_error);
  PixelCounts missing = pass.counts;
  missing.evaluated &= !by_tiles;
  if (missing.in_range || missing.evaluated || missing.list_length)
    timed(stats, Stage::kCountLights, [&] { countLights(input, missing, lighting.lists_in_range, lit); });
  stats.device_bytes = std::max(stats.device_bytes, bytesOf(input, clusters, lit));
  return lit;
}

}  // namespace luciole
