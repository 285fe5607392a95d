#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "luciole/array_memory.hpp"

namespace luciole {

using Texels = RawArray<std::uint16_t>;

/// One level of a mip chain: row-major, texel (0,0) top left.
struct MipLevel {
  int width = 0;
  int height = 0;
  /// 4 values a texel, RGBA, each 16-bit unsigned normalized. Alpha is linear. Colour is sRGB-encoded in the
  /// finest level (so that an 8-bit file's codes are kept exactly, as code × 257), and in the others the
  /// square root of the linear value, which decodes fast. 8 bytes a texel.
  Texels texels = {};
};

/// The meaning of a texture's numbers.
enum class TextureKind : std::uint8_t {
  kColor,
  kNormals,  ///< directions as (x, y, z) · ½ + ½: x to the right, y up in the picture, z out of the surface
  kBump,     ///< heights, which readers turn into kNormals; or normals in a map called a bump map
};

/// A filtered texture: levels[0] is the picture itself, each next level half the size, down to 1×1.
/// Never empty once loaded.
struct Texture {
  std::string name = {};  ///< for messages: the file's path, or its place inside a glTF file
  std::vector<MipLevel> levels = {};
  bool alpha_varies = false;  ///< between the texels of levels[0]
  TextureKind kind = TextureKind::kColor;
  bool linear = false;  ///< the file's numbers are linear: levels[0] has their sRGB codes
};

/// A texture of a picture in memory, with its mip chain, as loaders make them of a file. `texels`: 4 × width
/// × height, row-major, the top left first, RGBA, 16-bit unsigned normalized; an 8-bit code c is c × 257.
/// Colours of kColor are sRGB codes, or with `linear` linear numbers; alpha is always linear. Normals and
/// heights are always taken as the numbers that TextureKind says, and their alpha is ignored. Throws
/// InputError for another number of texels and for sides that aren't 1 to 32768, and MachineError. O(texels).
Texture makeTexture(int width, int height, std::span<const std::uint16_t> texels,
                    TextureKind kind = TextureKind::kColor, bool linear = false, std::string name = {});

}  // namespace luciole
