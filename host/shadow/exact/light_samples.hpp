#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "kernels/shared.h"

namespace luciole {

/// A sample of the disc that a light of a size shows, in polar coordinates: `share` is the share of the solid
/// angle inside its circle, 0 at the middle and 1 at the rim; cosine and sine are those of its azimuth.
struct LightSample {
  float share, cosine, sine;
};

/// The first kLightSamples points of I. Sobol's sequence (1967) in two dimensions. Each run of 2ᵐ of them
/// that begins at a multiple of 2ᵐ is a (0, m, 2)-net in base 2 (H. Niederreiter 1987). So a run of `samples`
/// is a pattern of low discrepancy, and the patterns of many points together are, too.
std::vector<LightSample> makeLightSamples();
inline constexpr int kLightSamples = 1 << 16;
/// Samples of a light from a point, at most.
inline constexpr int kMostSoftSamples = 1024;

/// The pattern of a light from a point: `samples` of makeLightSamples(). It depends on the bits of the
/// point's coordinates and on nothing else of a picture, so crops, bands and samples of a pixel have their
/// own. light: its index in the scene.
std::span<const LightSample> patternOf(std::span<const LightSample> all, int samples, const glm::vec3& start,
                                       std::uint32_t light);

/// Sets the samples of a light of a size for a point: positions on the near side of its sphere, or directions
/// to a directional light, as BeamLight::place. They are uniform by solid angle in the cone in which the
/// light is seen. `to` has the length of `pattern`. Returns false if the point is inside the light: then all
/// of it is visible.
bool placeSamples(const BeamLight& light, const glm::vec3& start, std::span<const LightSample> pattern,
                  std::span<float4> to);

}  // namespace luciole
