#pragma once

#include <cstdint>
#include <span>

#include "kernels/shared.h"
#include "raster/meshlets.hpp"
#include "raster/view.hpp"
#include "scene/scene.hpp"

namespace luciole {

/// How far, in texels, the square for which a BoundTexel holds reaches beyond the texel on each of its four
/// sides. Snapping to 1/256 texel moves a corner by up to 1/512 texel in x and in y, and with it every point
/// of its triangle. Of the 4/512, one is for the corners here, one for those of the picture that the result
/// is compared with, and two for the rounding of a lookup's place.
constexpr double kBoundGrowth = 1.0 / 128;

/// Inside that square a BoundTexel's plane differs from the triangle's by at most kPlaneError · (|depth| +
/// |step_x| + |step_y|). Half of this is the rounding to float: of depth (2⁻²⁴), and of steps, which are
/// taken up to .51 times (2⁻²⁵). The other half is for errors of the corners; triangles whose corners are
/// less exact don't count as covering.
constexpr float kPlaneError = 0x1p-23f;

/// Draws bounds of the depth that each texel of a view's crop sees (see BoundTexel), row by row into
/// `texels`. Arguments are those of rasterizeDepth; texels of a bin that isn't drawn keep their content.
/// Corners are transformed in double and not snapped. Triangles with corners that aren't finite as floats are
/// left out. A texel's content doesn't depend on the crop, on the number of threads, or on meshlets that
/// don't reach it. Where something reaches behind the near plane inside a texel's square, `others` is
/// infinite. Throws InputError as placeObjects does.
void rasterizeBounds(const Scene& scene, const Meshlets& meshlets, std::span<const std::uint32_t> chosen,
                     const View& view, std::span<const float> farthest, std::span<BoundTexel> texels);

}  // namespace luciole
