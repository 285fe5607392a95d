#pragma once

#include <cstddef>

#include "luciole/gbuffer.hpp"

namespace luciole {

/// Fills the normals of a G-buffer whose positions are there, in view space: those of the planes through
/// neighbouring positions, towards the viewer. Of the neighbours left and right, and of those above and
/// below, the side is taken that lies straighter behind the pixel: the inverse depth that the next two pixels
/// there lead one to expect, which is linear over a plane (in a parallel view, the depth itself), is nearer
/// to the pixel's own. Where it is off by more than a fiftieth on both sides, or there are no two pixels, an
/// edge is there. Such a pixel gets no normal and becomes one that shows nothing. Returns how many do.
std::size_t rebuildNormals(GBuffer& gbuffer);

}  // namespace luciole
