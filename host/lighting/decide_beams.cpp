#include "lighting/stages.hpp"

namespace luciole {

PairShadows decideBeams(const StageInput& input) {
  const FeatureSet& features = input.pass.features;
  const GBufferBuffers& planes = input.points.buffers;
  return beamShadows(input.device, featureDefines(featuresFor(kForBeams, features)),
                     {.plane_stride = input.points.stride,
                      .position = planes.position,
                      .normal = planes.normal,
                      .lift = planes.lift,
                      .lists = input.lists,
                      .lights = input.pass.lights.beam_buffer,
                      .beams = input.lighting.beams,
                      .holes = features.has(Feature::kHoles),
                      .soft = features.has(Feature::kSoftExact)});
}

TracedPairs traceUnsurePairs(const StageInput& input, PairShadows& pairs) {
  return tracePairs(input.device, input.scene, input.lighting.beams, input.pass.lights, input.pass.gbuffer,
                    input.lists, input.pass.features.has(Feature::kSoftExact), pairs);
}

PairBuffers borrowPairs(OpenedDevice& device, const PairShadows& pairs) {
  return {borrowed(device, pairs.lit), borrowed(device, pairs.unsure), borrowed(device, pairs.first_share),
          borrowed(device, pairs.shares)};
}

}  // namespace luciole
