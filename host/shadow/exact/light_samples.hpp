#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "kernels/exact/light_samples.h"
#include "kernels/shared.h"

namespace luciole {

/// The first kLightSamples points of I. Sobol's sequence (1967) in two dimensions. Each run of 2ᵐ of them
/// that begins at a multiple of 2ᵐ is a (0, m, 2)-net in base 2 (H. Niederreiter 1987). So a run of `samples`
/// is a pattern of low discrepancy, and the patterns of many points together are, too.
std::vector<LightSample> makeLightSamples();

/// The cosines of which kernels make the samples: see light_sample() in kernels/exact/light_samples.h.
std::vector<float> quarterCosines();

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
