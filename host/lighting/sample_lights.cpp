#include <tbb/parallel_for.h>

#include <algorithm>

#include "lighting/stages.hpp"
#include "shade/sampled_light.hpp"
#include "shade/seen_rounding.hpp"

namespace luciole {
namespace {

/// The share of the allowed error that lights with a place may take where directional lights are sampled,
/// too: its square is half, since the squares of half widths add up.
constexpr float kFirstShare = 0.7071f;

/// A borrowed buffer that kernels read and write. It starts with what the plane holds.
Buffer<float> borrowedForUpdate(OpenedDevice& device, Plane& plane) {
  const Buffer<float> buffer = borrowedForOutput(device, plane);
  if (!device.shares_host_memory)
    bytes::write(device, buffer.memory, plane.data(), {0, plane.size() * sizeof(float)});
  return buffer;
}

}  // namespace

void sampleLights(const StageInput& input, const ShadeFrame& frame, BoundedLight& result) {
  const FeatureSet& features = input.pass.features;
  const LightSet& lights = input.pass.lights;
  result.half_width.resize(3 * input.points.stride);
  const Buffer<float> light = borrowedForUpdate(input.device, result.light),
                      bound = borrowedForUpdate(input.device, result.bound),
                      half_width = borrowedForUpdate(input.device, result.half_width);
  const std::string defines =
      featureDefines(featuresFor(kForSampling, input.compiled)) + input.lighting.math_defines;
  for (const SampledSet* set : {&lights.samples, &lights.directions}) {
    if (set->lights == 0) continue;
    const bool directions = set == &lights.directions;
    SampleSettings settings = input.lighting.samples;
    const float share = !directions && lights.directions.lights > 0 ? kFirstShare : 1.0f;
    settings.light_error = clusteredError(share * settings.light_error, frame, features);
    const SampledLightCounts counts = sampledLight(input.device, defines,
                                                   {.frame = frame,
                                                    .gbuffer = input.points.buffers,
                                                    .lights = *set,
                                                    .directions = directions,
                                                    .beams = input.lighting.beams,
                                                    .settings = settings,
                                                    .holes = features.has(Feature::kHoles),
                                                    .light = light,
                                                    .bound = bound,
                                                    .half_width = half_width});
    SampledLightCounts& sums = result.sample_counts;
    sums.rays += counts.rays;
    sums.strata += counts.strata;
    sums.rounds += counts.rounds;
    sums.groups += counts.groups;
    sums.missed = std::max(sums.missed, counts.missed);
  }
  download(input.device, light, result.light);
  download(input.device, bound, result.bound);
  download(input.device, half_width, result.half_width);
  tbb::parallel_for(std::size_t(0), result.bound.size(),
                    [&](std::size_t i) { result.bound[i] += result.half_width[i]; });
}

}  // namespace luciole
