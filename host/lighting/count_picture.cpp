#include "lighting/count_picture.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "kernels/shared.h"
#include "lights/exact_reason.hpp"

namespace luciole {
namespace {

/// Adds the bounds of the error of clustered light to Stats::light_error.
void countLightErrors(const GBuffer& gbuffer, const LitPlanes& lit, Stats& stats) {
  const std::size_t n = gbuffer.pixels();
  const auto add = [&](const tbb::blocked_range<std::size_t>& range, LightErrorStats bounds) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      if (!std::isfinite(gbuffer.position[i + 2 * n])) continue;
      for (int c = 0; c < 3; ++c) {
        const double bound = lit.light_error[i + c * n];
        bounds.largest = std::max(bounds.largest, bound);
        bounds.sum += bound;
        bounds.least = std::max(bounds.least, bound / std::max(1.0, double(lit.color[i + c * n])));
      }
      bounds.values += 3;
    }
    return bounds;
  };
  const auto join = [](const LightErrorStats& a, const LightErrorStats& b) {
    return LightErrorStats{std::max(a.largest, b.largest), a.sum + b.sum, std::max(a.least, b.least),
                           a.values + b.values};
  };
  // The sum's order, and with it its last bits, doesn't depend on the threads.
  stats.light_error = join(stats.light_error, tbb::parallel_deterministic_reduce(
                                                  tbb::blocked_range<std::size_t>(0, n, kTilePixels),
                                                  LightErrorStats{}, add, join));
}

}  // namespace

void addCount(Stats& stats, const std::string& name, std::uint64_t count) {
  for (auto& [known, sum] : stats.counts) {
    if (known == name) {
      sum += count;
      return;
    }
  }
  stats.counts.emplace_back(name, count);
}

void countClusters(const ClusteredLightCounts& counts, Stats& stats) {
  addCount(stats, "pixel_clusters_evaluated", counts.clusters);
  addCount(stats, "pixel_clustered_lights_evaluated", counts.lights);
  addCount(stats, "pixels_redone", counts.redone);
}

void countLightUses(const Scene& scene, const ShadeSettings& settings, const Lighting& lighting,
                    Stats& stats) {
  if (!(settings.light_error > 0) || !scene.lighting) return;
  addCount(stats, "lights_stood_for", lighting.lights.clusters.lights);
  addCount(stats, "lights_exact", scene.lights.size() - lighting.lights.clusters.lights);
  const auto counts = countReasons(scene.lights, clusterConditions(settings));
  for (std::size_t reason = 1; reason < counts.size(); ++reason)
    if (counts[reason] > 0)
      addCount(stats, std::string("lights_exact_by_") + exactReasonName(ExactReason(reason)), counts[reason]);
  const std::size_t few = counts[0] - lighting.lights.clusters.lights;
  if (few > 0) addCount(stats, "lights_exact_as_few", few);
}

std::uint64_t coveredPixels(const GBuffer& gbuffer) {
  const float* depth = gbuffer.position.data() + 2 * gbuffer.pixels();
  return tbb::parallel_reduce(
      tbb::blocked_range<std::size_t>(0, gbuffer.pixels()), std::uint64_t(0),
      [&](const tbb::blocked_range<std::size_t>& range, std::uint64_t sum) {
        return sum + std::count_if(depth + range.begin(), depth + range.end(),
                                   [](float z) { return z > -std::numeric_limits<float>::infinity(); });
      },
      std::plus<>());
}

void countPass(const GBuffer& gbuffer, const LitPlanes& lit, bool counted, Stats& stats) {
  addCount(stats, "pixels_lit", coveredPixels(gbuffer));
  if (counted) addCount(stats, "pixel_lights_evaluated", lit.evaluated);
  if (lit.by_beams > 0) addCount(stats, "shadow_pairs_exact", lit.by_beams);
  if (lit.by_maps > 0) addCount(stats, "shadow_pairs_by_maps", lit.by_maps);
  addCount(stats, "list_entries", lit.list_entries);
  if (!lit.light_error.empty()) {
    countClusters(lit.clustered, stats);
    countLightErrors(gbuffer, lit, stats);
  }
  if (lit.pairs.soft_lit + lit.pairs.soft_dark + lit.traced.soft > 0) {
    addCount(stats, "soft_pairs_lit", lit.pairs.soft_lit);
    addCount(stats, "soft_pairs_dark", lit.pairs.soft_dark);
    addCount(stats, "soft_pairs_by_rays", lit.traced.soft);
  }
  if (lit.traced.rays > 0) addCount(stats, "shadow_rays", lit.traced.rays);
  if (lit.light_count.empty()) return;
  double in_range = 0;
  for (const float count : lit.light_count) in_range += count;
  addCount(stats, "pixel_lights_in_range", static_cast<std::uint64_t>(in_range));
}

void addRasterCounts(const RasterCounts& counts, Stats& stats) {
  addCount(stats, "triangles_submitted", counts.submitted);
  addCount(stats, "triangles_back_facing", counts.back_facing);
  addCount(stats, "triangles_outside", counts.outside);
}

void countShadows(const Lighting& lighting, Stats& stats) {
  const ShadowMaps& shadows = lighting.maps.host;
  const std::vector<BeamLight>& lights = lighting.lights.beam_lights;
  const std::size_t exact =
      std::count_if(lights.begin(), lights.end(), [](const BeamLight& light) { return light.casts != 0; });
  if (shadows.maps.size() + exact == 0) return;
  addCount(stats, "shadow_lights", shadows.maps.size() + exact);
  if (exact > 0) addCount(stats, "shadow_lights_exact", exact);
  if (shadows.maps.empty()) return;
  addCount(stats, "shadow_lights_by_maps", shadows.maps.size());
  addCount(stats, "shadow_lights_reduced", shadows.reduced_lights);
  std::uint64_t drawn = 0;
  for (const PlannedFace& face : shadows.planned) drawn += face.count.x > 0;
  addCount(stats, "shadow_faces_drawn", drawn);
  addCount(stats, "shadow_bytes", shadows.texels.size() * sizeof(ShadowTexel));
}

}  // namespace luciole
