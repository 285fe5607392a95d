#pragma once

#include <cstdint>
#include <vector>

#include "luciole/gbuffer.hpp"
#include "raster/shading_points.hpp"

namespace luciole {

/// The largest difference between the colour of a pixel's first point and the mean of its neighbours on the
/// same surface, as a share of the brightest of them, in a picture of so many samples a pixel. At the edge of
/// a shadow or highlight it is half of the step, the largest error of the point. Of few samples one has the
/// same weight. Below 1/16 twice as many points are shaded for a tenth less error.
constexpr float mostUneven(int samples) { return samples < 16 ? 1.0f / float(samples) : 1.0f / 16; }

/// The pixels of sampled.inner whose first points differ by more than mostUneven() from the mean of their
/// neighbours to the left and right, or above and below: 1 or 0 for each pixel, row by row. With a single
/// neighbour on the surface half of the difference counts. Colours are divided by the diffuse reflectance,
/// since points average maps already. color: of the first points, r g b, without exposure.
std::vector<std::uint8_t> unevenPixels(const SampledView& sampled, const SharedSamples& shared,
                                       const Plane& color);

}  // namespace luciole
