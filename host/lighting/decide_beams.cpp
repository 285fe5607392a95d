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
  const FeatureSet& features = input.pass.features;
  return tracePairs({.device = input.device,
                     .defines = featureDefines(featuresFor(kForBeams, features)),
                     .scene = input.scene,
                     .beams = input.lighting.beams,
                     .lights = input.pass.lights,
                     .gbuffer = input.pass.gbuffer,
                     .lists = input.lists,
                     .soft = features.has(Feature::kSoftExact)},
                    pairs);
}

}  // namespace luciole
