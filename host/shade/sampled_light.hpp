#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "lights/light_set.hpp"
#include "luciole/settings.hpp"
#include "raster/view.hpp"
#include "shade/shade.hpp"
#include "shadow/exact/beam_shadows.hpp"

namespace luciole {

/// How wide the intervals of sampled light may be, and what its random numbers are of.
struct SampleSettings {
  float light_error =
      0;  ///< E > 0: a half width shall be E·max(least_value, the light), seen through the fog
  float least_value = 1;
  double deviations = 0;  ///< the half width in standard deviations: deviationsOf()
  std::uint32_t seed = 0;
  float4 to_pixel{};  ///< pixelsOf(): random numbers are of a pixel's place in the whole picture
};

/// The half width, in estimated standard deviations, of the interval that holds a value with this
/// probability, in (0, 1): of Student's distribution, as the deviation is estimated from samples, too.
double deviationsOf(double confidence);

/// SampleSettings::to_pixel of a picture.
float4 pixelsOf(const View& view);

struct SampledLightArguments {
  const ShadeFrame& frame;
  const GBufferBuffers& gbuffer;
  const SampledSet& lights;
  bool directions;  ///< the lights are directional
  const BeamScene& beams;
  const SampleSettings& settings;
  bool holes;  ///< with Feature::kHoles
  /// Planes r g b of what surfaces reflect, of proven errors, and of half widths that aren't proven, both as
  /// seen through the fog: of other lights. What is sampled is added.
  Buffer<float> light, bound, half_width;
};

/// The counts of sampledLight().
struct SampledLightCounts {
  std::uint64_t rays = 0;
  std::uint64_t strata = 0, rounds = 0;  ///< of all groups of pixels
  std::uint64_t groups = 0;
  std::uint64_t missed = 0;  ///< pixels of groups whose intervals stayed wider than allowed
};

/// Launches kernels/sampled/sampled_light.cl on every tile of the G-buffer and waits for it. defines: the
/// program's features (featureDefines) and mathDefines. Throws MachineError.
SampledLightCounts sampledLight(OpenedDevice& device, const std::string& defines,
                                const SampledLightArguments& arguments);

/// Lights that could be sampled, in a picture.
struct SampleableLights {
  std::size_t count, casting;  ///< the lights, and those of them that cast shadows
  double points;               ///< shaded points of the picture
  double triangles;            ///< of the scene
};

/// The estimated rays that sampling traces for a point.
double sampledRays(std::size_t lights, const ShadeSettings& settings);

/// The estimated milliseconds of sampling, on two cores of an AMD EPYC of 2024. It is computed, not timed, so
/// no picture depends on the machine.
double sampledMilliseconds(const SampleableLights& lights, const ShadeSettings& settings);

}  // namespace luciole
