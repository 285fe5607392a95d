#pragma once

#include "luciole/texture.hpp"

namespace luciole {

/// The height of white above black in a bump map, as a share of the picture's longer side.
inline constexpr double kBumpHeight = 0.01;

/// Makes a texture of kNormals of one that was read as a colour picture, or of heights with kBump: its
/// codes are taken as numbers, not as sRGB. Levels are encoded so that lookups, which decode colours, return
/// the numbers in [0, 1]. A coarse normal is the mean of finer ones, so it is shorter than 1 where they
/// differ. Alpha becomes 1. Heights are the means of red, green and blue, and slopes are central differences
/// with wrap-around. A kBump picture whose mean is within 0.15 of (½, ½) with a blue of 0.7 or more is taken
/// for normals. O(texels).
void makeNormals(TextureKind kind, Texture& texture);

}  // namespace luciole
