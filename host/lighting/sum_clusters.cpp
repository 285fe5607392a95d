#include <tbb/parallel_for.h>

#include "lighting/stages.hpp"
#include "shade/seen_rounding.hpp"

namespace luciole {
namespace {

/// The share of the allowed error that clusters may take where other lights are sampled.
constexpr float kProvenShare = 0.25f;

}  // namespace

BoundedLight sumClusters(const StageInput& input, const ShadeFrame& frame) {
  const GBuffer& gbuffer = input.pass.gbuffer;
  const FeatureSet& features = input.pass.features;
  const ClusterSet& clusters = input.pass.lights.clusters;
  BoundedLight result;
  result.light.resize(3 * input.points.stride);
  result.bound.resize(3 * input.points.stride);
  if (clusters.lights > 0) {
    const SampleSettings& settings = input.lighting.samples;
    // Samples take what the proof leaves, and most of the time.
    const float share = features.sampledLight() ? kProvenShare : 1.0f;
    const Buffer<float> light = borrowedForOutput(input.device, result.light),
                        bound = borrowedForOutput(input.device, result.bound);
    result.cluster_counts = clusteredLight(
        input.device, featureDefines(featuresFor(kForClusters, input.compiled)) + input.lighting.math_defines,
        {.frame = frame,
         .gbuffer = input.points.buffers,
         .tiles_x = gbuffer.tiles_x,
         .tiles_y = gbuffer.tiles_y,
         .clusters = clusters.diffuse,
         .highlights = clusters.specular.lights == 0 ? clusters.diffuse : clusters.specular,
         .light_error = clusteredError(share * settings.light_error, frame, features),
         .least_value = settings.least_value,
         .light = light,
         .bound = bound});
    download(input.device, light, result.light);
    download(input.device, bound, result.bound);
  }
  if (!gbuffer.emission.empty() && input.pass.lights.emission)
    tbb::parallel_for(std::size_t(0), result.light.size(),
                      [&](std::size_t i) { result.light[i] += gbuffer.emission[i]; });
  return result;
}

}  // namespace luciole
