#pragma once

#include <array>
#include <glm/glm.hpp>

#include "kernels/shared.h"
#include "raster/bins.hpp"
#include "raster/bound_setup.hpp"

namespace luciole {

/// Two sides of a row and two of a column cut a piece: at most 7, 10, 15, 22, 33 corners, see clipPolygon.
using TexelPolygon = Polygon<glm::dvec3, 33>;

/// A bin of texels on its way.
struct BoundBin {
  glm::ivec2 origin;  ///< its top left texel, in the whole picture
  std::array<BoundTexel, kBinSize * kBinSize> texels;
  std::array<const BoundPiece*, kBinSize * kBinSize> covering;  ///< whose plane it is, if any
  std::array<double, kBinSize * kBinSize> lowest;  ///< of the plane: what is below is certainly behind it
  std::array<TexelPolygon, 4> polygons;  ///< for drawOther, which would else clear their room for every piece
};

/// Nothing drawn yet. unknown: some triangle may be anywhere, so `others` are infinite.
void clearBin(const glm::ivec2& origin, bool unknown, BoundBin& bin);

/// Takes the plane of a piece that is `covering`, wherever the piece covers a texel and lies higher than what
/// was there. The piece must outlive the bin. O(texels of its box).
void drawPlane(const BoundPiece& piece, BoundBin& bin);

/// Raises `others` wherever a piece may be in front of the plane. To be called for every piece once all
/// planes are drawn. O(texels of its box), and less where it is far behind.
void drawOther(const BoundPiece& piece, BoundBin& bin);

/// The float at or next above a value.
float roundUp(double value);

}  // namespace luciole
