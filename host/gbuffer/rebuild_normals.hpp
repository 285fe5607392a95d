#pragma once

#include <cstddef>

#include "luciole/gbuffer.hpp"

namespace luciole {

/// Computes the normals of a G-buffer from its view-space positions: of the planes through neighbouring
/// positions, towards the viewer. Of the neighbours left and right, and of those above and below, it takes
/// the side whose next two pixels extrapolate better to the pixel's inverse depth, which is linear over a
/// plane (in a parallel view, the depth itself). If the extrapolation is off by more than a fiftieth on both
/// sides, or there are no two pixels, the pixel is an edge: it becomes background. Returns the number of such
/// pixels.
std::size_t rebuildNormals(GBuffer& gbuffer);

}  // namespace luciole
