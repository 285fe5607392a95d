#include "lighting/stages.hpp"
#include "shade/sampled_light.hpp"
#include "shade/seen_rounding.hpp"

namespace luciole {
namespace {

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
  result.half_width.resize(3 * input.points.stride);
  const Buffer<float> light = borrowedForUpdate(input.device, result.light),
                      bound = borrowedForUpdate(input.device, result.bound),
                      half_width = borrowedForUpdate(input.device, result.half_width);
  SampleSettings settings = input.lighting.samples;
  settings.light_error = clusteredError(settings.light_error, frame, features);
  result.sample_counts = sampledLight(
      input.device, featureDefines(featuresFor(kForSampling, input.compiled)) + input.lighting.math_defines,
      {.frame = frame,
       .gbuffer = input.points.buffers,
       .lights = input.pass.lights.samples,
       .beams = input.lighting.beams,
       .settings = settings,
       .holes = features.has(Feature::kHoles),
       .light = light,
       .bound = bound,
       .half_width = half_width});
  download(input.device, light, result.light);
  download(input.device, bound, result.bound);
  download(input.device, half_width, result.half_width);
}

}  // namespace luciole
