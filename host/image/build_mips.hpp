#pragma once

#include "luciole/texture.hpp"

namespace luciole {

/// Appends the coarser levels of the mip chain to a texture that has only its finest level: each max(1, ⌊side
/// / 2⌋) texels a side, down to 1×1. A coarse texel is the mean, in linear light, of exactly the area it
/// covers; where a side is odd that is three texels, weighted by the parts of them that it covers. Colours
/// are weighted by alpha, or equally where all alphas are 0. Sets Texture::alpha_varies. O(texels).
void buildMips(Texture& texture);

}  // namespace luciole
