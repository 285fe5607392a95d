#pragma once

#include <glm/glm.hpp>
#include <span>

#include "luciole/image.hpp"

namespace luciole {

/// Exposures are in stops: colours are multiplied by 2^stops. An exposure is at most so large, and at least
/// minus that.
inline constexpr double kMostStops = 100;

/// The exposure, in whole hundredths of a stop, that brings the logarithmic mean of the colours' luminances
/// to 0.18, a photographer's middle grey (E. Reinhard et al., "Photographic Tone Reproduction for Digital
/// Images", 2002, equations 1 and 2, with the key 0.18). Black doesn't count, since no exposure changes
/// it; nor do the darkest and the brightest tenth of the rest, so that sparks of a few pixels don't matter. 0
/// where nothing is left. colors: linear Rec.709; their order doesn't matter. NaN counts as black.
double suitableExposure(std::span<const glm::vec3> colors);

/// The size at which a picture's exposure is measured: of its aspect, at most 256 pixels a side. So crops,
/// bands, frames and other sizes get the same exposure.
glm::ivec2 measuringSize(glm::ivec2 picture_size);

/// Multiplies R, G and B by 2^stops. What would be infinite becomes the largest finite value.
void expose(Image& image, double stops);

}  // namespace luciole
