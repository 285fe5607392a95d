#pragma once

#include <cstdint>
#include <span>

#include "kernels/shared.h"
#include "raster/meshlets.hpp"
#include "raster/view.hpp"
#include "scene/scene.hpp"

namespace luciole {

/// How much larger than a texel, on each of its four sides, the square is for which a BoundTexel holds.
/// Corners that are snapped to 1/256 texel move by 1/512 texel in x and in y, and with them every point of
/// their triangle; as much again for the picture that the result is compared with, and twice as much for
/// whoever rounds the place of a lookup.
constexpr double kBoundGrowth = 1.0 / 128;

/// Inside that square a BoundTexel's plane differs from the triangle's by at most
/// kPlaneError · (|depth| + |step_x| + |step_y|): float's rounding of depth (2⁻²⁴) and of steps that are
/// taken .51 times (2⁻²⁵), and twice as much for the corners, which covering triangles must have to that
/// precision.
constexpr float kPlaneError = 0x1p-23f;

/// Draws what the texels of a view's crop see for certain, see BoundTexel; row by row into `texels`.
/// Arguments are those of rasterizeDepth: texels of a bin that isn't drawn are left as they are. Triangles
/// are what their corners are after transformation in double; those whose corners aren't finite as floats
/// don't exist. A texel's content does not depend on the crop, on the number of threads, or on meshlets that
/// don't reach it. What reaches behind the near plane inside a texel's square makes `others` infinite there.
void rasterizeBounds(const Scene& scene, const Meshlets& meshlets, std::span<const std::uint32_t> chosen,
                     const View& view, std::span<const float> farthest, std::span<BoundTexel> texels);

}  // namespace luciole
