#pragma once

#include "luciole/texture.hpp"

namespace luciole {

/// How far white stands above black in a picture of heights, as a share of the picture's longer side.
inline constexpr double kBumpHeight = 0.01;

/// Makes a texture of kNormals of one that was read as a colour picture, or of heights with kBump: its
/// numbers are taken as they are, not as sRGB. The levels are written so that lookups, which decode colours,
/// give the numbers in [0, 1]; a coarse one is the mean of the finer, so it is shorter than 1 where normals
/// differ. Opaque. Heights are the means of red, green and blue, and slopes are the differences of a texel's
/// neighbours, around the edges. A picture of kBump whose mean is within 0.15 of (½, ½) with a blue of 0.7 or
/// more holds normals, which programs also call a bump map. O(texels).
void makeNormals(TextureKind kind, Texture& texture);

}  // namespace luciole
