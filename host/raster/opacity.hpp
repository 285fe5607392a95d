#pragma once

#include "raster/square.hpp"
#include "raster/surface.hpp"

namespace luciole {

/// The opacity of a surface at a point: the product of its material's alpha, the vertex colour's, and that of
/// its maps, looked up at `place`. Uses only the surface's object, material and corners.
float opacityAt(const Scene& scene, const Surface& surface, const Weights& weights,
                const TexturePlace& place);

/// Whether a triangle of an object (counted in its mesh) has a hole at a place given by barycentric weights:
/// its opacity there, with maps looked up at their finest level, is below its material's alpha_cutoff.
bool isHoleAt(const Scene& scene, const PlacedObject& object, std::uint32_t triangle, const Weights& weights);

/// Whether the surface has a hole at (x, y), as in ViewPlane::at: its opacity is below its material's
/// alpha_cutoff, which must be > 0.
bool isHole(const Scene& scene, const Surface& surface, const ViewPlane& plane, double x, double y);

/// The same, bit for bit, for the wanted ones of several places at once: 1 where there is a hole, 0
/// elsewhere.
LaneMask holesIn(const Scene& scene, const Surface& surface, const ViewPlane& plane, const Lanes<double>& x,
                 const Lanes<double>& y, const LaneMask& wanted);

}  // namespace luciole
