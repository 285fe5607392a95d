#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include "luciole/gbuffer.hpp"
#include "raster/seen_surface.hpp"
#include "raster/square_values.hpp"

namespace luciole {

/// Calls visit(square) with the top left pixel of every square that a part of a crop touches. Squares, like
/// tiles, are aligned to the crop, and bins to the picture. So a square may lie in several bins.
template <class Visit>
void forEachSquare(const PixelRectangle& part, const glm::ivec2& crop_origin, Visit visit) {
  const glm::ivec2 first = crop_origin + (part.first - crop_origin) / kSquareSize * kSquareSize;
  for (int y = first.y; y < part.end.y; y += kSquareSize)
    for (int x = first.x; x < part.end.x; x += kSquareSize) visit(glm::ivec2(x, y));
}

/// Writes the attributes of the triangles that a square's pixels see at `place` to the G-buffer, from `at` on
/// in its planes. Pixels that see kNoTriangle keep their content. finishSquares() must follow.
void resolveSquare(const ResolveInput& input, const SquarePlace& place, const Lanes<std::uint32_t>& triangles,
                   SurfaceCache& surfaces, std::size_t at, GBuffer& gbuffer);

/// Ends a thread's calls of resolveSquare(): other threads see what they wrote once they know of this call.
void finishSquares();

}  // namespace luciole
