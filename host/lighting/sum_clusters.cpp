#include <tbb/parallel_for.h>

#include "lighting/stages.hpp"
#include "shade/seen_rounding.hpp"

namespace luciole {

ClusterLight sumClusters(const StageInput& input, const ShadeFrame& frame) {
  const GBuffer& gbuffer = input.pass.gbuffer;
  const FeatureSet& features = input.pass.features;
  const ClusterSet& clusters = input.pass.lights.clusters;
  ClusterLight result;
  result.light.resize(3 * input.points.stride);
  result.bound.resize(3 * input.points.stride);
  {
    const Buffer<float> light = borrowedForOutput(input.device, result.light),
                        bound = borrowedForOutput(input.device, result.bound);
    result.counts = clusteredLight(
        input.device, featureDefines(featuresFor(kForClusters, features)) + input.lighting.math_defines,
        {.frame = frame,
         .gbuffer = input.points.buffers,
         .tiles_x = gbuffer.tiles_x,
         .tiles_y = gbuffer.tiles_y,
         .clusters = clusters.diffuse,
         .highlights = clusters.specular.rows.empty() ? clusters.diffuse : clusters.specular,
         .light_error = clusteredError(clusters.light_error, frame, features),
         .light = light,
         .bound = bound});
    download(input.device, light, result.light);
    download(input.device, bound, result.bound);
  }
  if (!gbuffer.emission.empty())
    tbb::parallel_for(std::size_t(0), result.light.size(),
                      [&](std::size_t i) { result.light[i] += gbuffer.emission[i]; });
  return result;
}

}  // namespace luciole
