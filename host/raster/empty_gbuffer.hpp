#pragma once

#include <cstddef>

#include "luciole/gbuffer.hpp"
#include "raster/view.hpp"

namespace luciole {

/// Throws InputError for a view whose size or crop is out of range.
void checkView(const View& view);

/// A G-buffer of a view's crop that shows background. `recycled`: a G-buffer whose memory is reused. Throws
/// as allocateArray does.
GBuffer emptyGBuffer(const View& view, PlaneSet planes, GBuffer recycled = {});

/// A G-buffer of so many columns and rows of tiles that shows background, for points that don't lie in a
/// picture. `recycled`: as above. Throws as allocateArray does.
GBuffer emptyPoints(const View& view, glm::ivec2 tiles, PlaneSet planes, GBuffer recycled = {});

}  // namespace luciole
