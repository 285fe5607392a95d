#include "lighting/count_picture.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "kernels/shared.h"
#include "lights/light_use.hpp"

namespace luciole {
namespace {

/// Adds the intervals of the light to Stats::light_error.
void countLightErrors(const GBuffer& gbuffer, const LitPlanes& lit, double least_value, Stats& stats) {
  const std::size_t n = gbuffer.pixels();
  const auto add = [&](const tbb::blocked_range<std::size_t>& range, LightErrorStats bounds) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      if (!std::isfinite(gbuffer.position[i + 2 * n])) continue;
      for (int c = 0; c < 3; ++c) {
        const double bound = lit.light_error[i + c * n];
        bounds.largest = std::max(bounds.largest, bound);
        bounds.sum += bound;
        const double proven = bound - (lit.half_width.empty() ? 0.0 : double(lit.half_width[i + c * n]));
        bounds.proven += proven;
        bounds.least = std::max(bounds.least, proven / std::max(least_value, double(lit.color[i + c * n])));
      }
      bounds.values += 3;
    }
    return bounds;
  };
  const auto join = [](const LightErrorStats& a, const LightErrorStats& b) {
    return LightErrorStats{std::max(a.largest, b.largest), a.sum + b.sum, a.proven + b.proven,
                           std::max(a.least, b.least), a.values + b.values};
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

void countStandIns(const LitPlanes& lit, Stats& stats) {
  addCount(stats, "pixel_clusters_evaluated", lit.clustered.clusters);
  addCount(stats, "pixel_clustered_lights_evaluated", lit.clustered.lights);
  addCount(stats, "pixels_redone", lit.clustered.redone);
  if (lit.half_width.empty()) return;
  addCount(stats, "sampled_rays", lit.sampled.rays);
  addCount(stats, "sampled_groups", lit.sampled.groups);
  addCount(stats, "sampled_strata", lit.sampled.strata);
  addCount(stats, "sampled_rounds", lit.sampled.rounds);
  addCount(stats, "pixels_beyond_light_error", lit.sampled.missed);
}

void countLightUses(const Scene& scene, const ShadeSettings& settings, const Lighting& lighting,
                    Stats& stats) {
  if (!(settings.light_error > 0) || !scene.lighting) return;
  const std::size_t clustered = lighting.lights.clusters.lights,
                    sampled = lighting.lights.samples.lights + lighting.lights.directions.lights;
  addCount(stats, "lights_stood_for", clustered);
  if (sampled > 0) addCount(stats, "lights_sampled", sampled);
  addCount(stats, "lights_exact", scene.lights.size() - clustered - sampled);
  const LightUseCounts counts = countUses(scene.lights, useConditions(settings));
  for (std::size_t use = std::size_t(LightUse::kByModel); use < counts.size(); ++use)
    if (counts[use] > 0)
      addCount(stats, std::string("lights_exact_by_") + reasonName(LightUse(use)), counts[use]);
  const std::size_t few = counts[std::size_t(LightUse::kClustered)] +
                          counts[std::size_t(LightUse::kSampled)] +
                          counts[std::size_t(LightUse::kSampledDirection)] - clustered - sampled;
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

void countPass(const GBuffer& gbuffer, const LitPlanes& lit, bool counted, double least_value, Stats& stats) {
  addCount(stats, "pixels_lit", coveredPixels(gbuffer));
  if (counted) addCount(stats, "pixel_lights_evaluated", lit.evaluated);
  if (lit.faulty_pixels > 0) addCount(stats, kFaultyPixels, lit.faulty_pixels);
  if (lit.by_beams > 0) addCount(stats, "shadow_pairs_exact", lit.by_beams);
  if (lit.by_maps > 0) addCount(stats, "shadow_pairs_by_maps", lit.by_maps);
  addCount(stats, "list_entries", lit.list_entries);
  if (!lit.light_error.empty()) {
    countStandIns(lit, stats);
    countLightErrors(gbuffer, lit, least_value, stats);
  }
  if (lit.traced.soft_lit + lit.traced.soft_dark + lit.traced.soft > 0) {
    addCount(stats, "soft_pairs_lit", lit.traced.soft_lit);
    addCount(stats, "soft_pairs_dark", lit.traced.soft_dark);
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
