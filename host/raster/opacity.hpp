#pragma once

#include "raster/surface.hpp"

namespace luciole {

/// Of the surface at a point, whose maps are looked up at `place`; nothing but its object, material and
/// corners is looked at.
float opacityAt(const Scene& scene, const Surface& surface, const Weights& weights,
                const TexturePlace& place);

/// Whether the surface has a hole where the pixel looks. Its material's alpha_cutoff is > 0.
bool isHole(const Scene& scene, const Surface& surface, const ViewPlane& plane, int x, int y);

}  // namespace luciole
