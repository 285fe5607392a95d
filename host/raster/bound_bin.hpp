#pragma once

#include <array>
#include <glm/glm.hpp>

#include "kernels/shared.h"
#include "raster/bins.hpp"
#include "raster/bound_setup.hpp"

namespace luciole {

/// A piece cut by the two sides of a row and the two of a column: at most 7, 10, 15, 22, 33 corners (see
/// clipPolygon).
using TexelPolygon = Polygon<glm::dvec3, 33>;

/// A bin of texels while it is drawn. Arrays are row by row, one entry a texel.
struct BoundBin {
  glm::ivec2 origin;  ///< its top left texel, in the whole picture
  std::array<BoundTexel, kBinSize * kBinSize> texels;
  std::array<const BoundPiece*, kBinSize * kBinSize> covering;  ///< whose plane a texel has; null: none
  std::array<double, kBinSize * kBinSize> lowest;               ///< least depth of a texel's plane
  std::array<TexelPolygon, 4> polygons;  ///< for drawOther, which would else clear their room for every piece
};

/// Empties a bin. `unknown`: some triangle may be anywhere, so `others` become infinite.
void clearBin(const glm::ivec2& origin, bool unknown, BoundBin& bin);

/// Draws a piece that is `covering`: a texel whose whole square it covers takes its plane, if that is nearer
/// than the plane there. The bin keeps a pointer to the piece. O(texels of its box).
void drawPlane(const BoundPiece& piece, BoundBin& bin);

/// Raises `others` of the texels where a piece may be in front of the plane. To be called for every piece
/// once all planes are drawn. O(texels of its box); texels where it is hidden cost one comparison.
void drawOther(const BoundPiece& piece, BoundBin& bin);

/// The smallest float that is not below a value.
float roundUp(double value);

}  // namespace luciole
