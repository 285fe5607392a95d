#pragma once

#include <glm/glm.hpp>
#include <span>

#include "luciole/scene.hpp"
#include "raster/square.hpp"

namespace luciole {

/// Lookup of one channel, trilinear unless `use` says otherwise: linear red (0), green or blue, or alpha (3),
/// at `uv`, filtered over the footprint of a pixel, whose sides in texture coordinates are duv_dx and duv_dy
/// (any finite size; zero: the finest level). The level follows the longer side, as OpenGL does. Non-finite
/// coordinates read as 0.
float sampleTexture(const Texture& texture, const TextureUse& use, glm::vec2 uv, glm::vec2 duv_dx,
                    glm::vec2 duv_dy, int channel);

/// The texels of the finest level in a square as wide as a footprint's longer side; 0 where `use` has no
/// mips.
float texelsInside(const Texture& texture, const TextureUse& use, glm::vec2 duv_dx, glm::vec2 duv_dy);

/// Texture coordinates and footprints of a square's pixels, as above.
struct SquareFootprints {
  Lanes<float> u, v;
  Lanes<float> du_dx, dv_dx;
  Lanes<float> du_dy, dv_dy;
};

/// The same lookup, bit for bit, of linear red, green and blue for a square's pixels, each in its own map. 1
/// for a pixel whose map is null.
Lanes3<float> sampleTextures(std::span<const Texture> textures, const Lanes<const TextureUse*>& maps,
                             const SquareFootprints& footprints);

/// The same lookup, bit for bit, of one channel of a map for the wanted pixels; 0 for others.
Lanes<float> sampleChannel(const Texture& texture, const TextureUse& map, const SquareFootprints& footprints,
                           const LaneMask& wanted, int channel);

}  // namespace luciole
