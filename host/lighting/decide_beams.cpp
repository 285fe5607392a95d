#include "lighting/stages.hpp"

namespace luciole {
namespace {

std::string beamDefines(const StageInput& input) {
  return featureDefines(featuresFor(kForBeams, input.compiled));
}

BeamArguments beamArguments(const StageInput& input) {
  const FeatureSet& features = input.compiled;
  const GBufferBuffers& planes = input.points.buffers;
  return {.plane_stride = input.points.stride,
          .position = planes.position,
          .normal = planes.normal,
          .lift = planes.lift,
          .lists = input.lists,
          .lights = input.pass.lights.beam_buffer,
          .beams = input.lighting.beams,
          .holes = features.has(Feature::kHoles),
          .soft = features.has(Feature::kSoftExact)};
}

}  // namespace

PairShadows decideBeams(const StageInput& input) {
  return beamShadows(input.device, beamDefines(input), beamArguments(input));
}

TracedPairs traceUnsurePairs(const StageInput& input, PairShadows& pairs) {
  return tracePairs({.device = input.device,
                     .defines = beamDefines(input),
                     .arguments = beamArguments(input),
                     .scene = input.scene,
                     .lights = input.pass.lights,
                     .gbuffer = input.pass.gbuffer},
                    pairs);
}

}  // namespace luciole
