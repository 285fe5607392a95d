#pragma once

#include "image/texture.hpp"

namespace luciole {

/// Appends to a texture that has its finest level alone all coarser ones, each max(1, side / 2) texels a side
/// (rounded down), to 1×1. A coarse texel is the mean, in linear light, of exactly the area it covers: where
/// a side is odd, three texels with the weights of the parts they give. Colours are weighted by alpha, unless
/// every alpha there is 0. Sets Texture::alpha_varies.
void buildMips(Texture& texture);

}  // namespace luciole
