#pragma once

#include <cstddef>

#include "luciole/gbuffer.hpp"
#include "raster/view.hpp"

namespace luciole {

/// Throws InputError for a view whose size or crop is out of range.
void checkView(const View& view);

/// A G-buffer of a view's crop that shows nothing. `used`: one that is done with, whose memory it takes.
/// Throws as allocateArray does.
GBuffer emptyGBuffer(const View& view, PlaneSet planes, GBuffer recycled = {});

/// A G-buffer for single points, in so many columns and rows of tiles, that shows nothing. Throws as
/// allocateArray does.
GBuffer emptyPoints(const View& view, glm::ivec2 tiles, PlaneSet planes);

}  // namespace luciole
