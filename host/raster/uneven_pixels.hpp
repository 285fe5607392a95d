#pragma once

#include <cstdint>
#include <vector>

#include "luciole/gbuffer.hpp"
#include "raster/shading_points.hpp"

namespace luciole {

/// How far a pixel's first point may be from the mean of its neighbours on the same surface, as a share of
/// the brightest of them. Where the edge of a shadow or of a highlight goes through one of these pixels, that
/// is half of the step, the most that the point may err by. One of 16 samples weighs as much.
constexpr float kMostUneven = 1.0f / 16;

/// The pixels wanted whose first points are farther than kMostUneven from their neighbours to the left and
/// right, or above and below: 1 or 0 for each pixel, row by row. A point with one such neighbour may be twice
/// as far from it. What maps do to the reflectance doesn't count, since points average them. Exposure doesn't
/// matter. color: of the first points, r g b.
std::vector<std::uint8_t> unevenPixels(const SampledView& sampled, const SharedSamples& shared,
                                       const Plane& color);

}  // namespace luciole
