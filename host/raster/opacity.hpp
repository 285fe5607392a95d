#pragma once

#include "raster/surface.hpp"

namespace luciole {

/// The opacity of a surface at a point: the product of its material's alpha, the vertex colour's, and that of
/// its maps, looked up at `place`. Uses only the surface's object, material and corners.
float opacityAt(const Scene& scene, const Surface& surface, const Weights& weights,
                const TexturePlace& place);

/// Whether the surface has a hole at (x, y), as in ViewPlane::at: its opacity is below its material's
/// alpha_cutoff, which must be > 0.
bool isHole(const Scene& scene, const Surface& surface, const ViewPlane& plane, double x, double y);

}  // namespace luciole
