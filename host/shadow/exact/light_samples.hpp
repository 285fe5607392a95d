#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "kernels/shared.h"

namespace luciole {

/// A place on what is seen of a light of a size, by solid angle from its middle (share 0) to its rim (1), at
/// an angle.
struct LightSample {
  float share, cosine, sine;
};

/// kLightSamples places, of which every run of 2ᵐ, from a multiple of it on, is spread as evenly as can be: a
/// (0, m, 2)-net in base 2 (H. Niederreiter 1987), by I. Sobol's first two dimensions (1967). So runs of
/// `samples` each are patterns for points, and those of many points together fill what the patterns leave.
std::vector<LightSample> makeLightSamples();
inline constexpr int kLightSamples = 1 << 16;
/// Samples of a light from a point, at most.
inline constexpr int kMostSoftSamples = 1024;

/// The pattern of a light from a point: `samples` of makeLightSamples(). It depends on the bits of the
/// point's coordinates and on nothing else of a picture, so crops, bands and samples of a pixel have their
/// own. light: its index in the scene.
std::span<const LightSample> patternOf(std::span<const LightSample> all, int samples, const glm::vec3& start,
                                       std::uint32_t light);

/// Where a light of a size has its samples, as seen from a point: as BeamLight::place, on the near side of
/// its sphere, or a direction to a directional light. They are spread evenly over the cone in which the light
/// is seen, by solid angle. `to` has the length of `pattern`. Returns false where the point is inside the
/// light; then all of it is visible.
bool placeSamples(const BeamLight& light, const glm::vec3& start, std::span<const LightSample> pattern,
                  std::span<float4> to);

}  // namespace luciole
