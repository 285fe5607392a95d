#include "raster/resolve.hpp"

#include "raster/resolve_square.hpp"

namespace luciole {
namespace {

/// The triangles that a square's pixels see; kNoTriangle outside the part.
Lanes<std::uint32_t> trianglesSeen(const BinPixels& pixels, const glm::ivec2& bin_origin,
                                   const PixelRectangle& part, const glm::ivec2& square) {
  const glm::ivec2 in_bin = square - bin_origin;
  const bool whole = part.contains(square) && part.contains(square + (kSquareSize - 1));
  Lanes<std::uint32_t> triangles;
  for (int i = 0; i < kSquarePixels; ++i) {
    const glm::ivec2 step(kSquareLayout.x[i], kSquareLayout.y[i]);
    triangles[i] = whole || part.contains(square + step)
                       ? pixels.label[(in_bin.y + step.y) * kBinSize + in_bin.x + step.x]
                       : kNoTriangle;
  }
  return triangles;
}

bool seesNothing(const Lanes<std::uint32_t>& triangles) {
  bool sees = false;
  for (int i = 0; i < kSquarePixels; ++i) sees |= triangles[i] != kNoTriangle;
  return !sees;
}

}  // namespace

void resolveBin(const ResolveInput& input, const BinPixels& pixels, glm::ivec2 bin_origin,
                SurfaceCache& surfaces, GBuffer& gbuffer) {
  const glm::ivec2 crop = gbuffer.crop_origin;
  const PixelRectangle part{
      glm::max(bin_origin, crop),
      glm::min(bin_origin + kBinSize, crop + glm::ivec2(gbuffer.width, gbuffer.height))};
  forEachSquare(part, crop, [&](const glm::ivec2& square) {
    const Lanes<std::uint32_t> triangles = trianglesSeen(pixels, bin_origin, part, square);
    if (seesNothing(triangles)) return;
    resolveSquare(input, squarePlace(input.plane, square), triangles, surfaces,
                  gbuffer.index(square.x - crop.x, square.y - crop.y), gbuffer);
  });
  finishSquares();
}

}  // namespace luciole
