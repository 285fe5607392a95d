#include <fmt/format.h>

#include <cstddef>
#include <utility>

#include "base/machine_memory.hpp"
#include "base/picture_size.hpp"
#include "image/build_mips.hpp"
#include "image/make_normals.hpp"
#include "image/srgb.hpp"
#include "luciole/error.hpp"
#include "luciole/texture.hpp"

namespace luciole {

Texture makeTexture(int width, int height, std::span<const std::uint16_t> texels, TextureKind kind,
                    bool linear, std::string name) {
  const auto fail = [&](const std::string& fault) {
    throw InputError(name.empty() ? fault : name + ": " + fault);
  };
  if (width < 1 || height < 1 || width > kLargestSide || height > kLargestSide)
    fail(fmt::format("size: {}x{}, expected 1 to {} a side", width, height, kLargestSide));
  const std::size_t expected = 4 * std::size_t(width) * std::size_t(height);
  if (texels.size() != expected)
    fail(fmt::format("texels: has {} elements, expected {}, 4 a texel", texels.size(), expected));
  // The mip chain takes a third more.
  requireMemory(4.0 / 3 * double(texels.size_bytes()), name.empty() ? "a texture" : name);

  Texture texture{.name = std::move(name)};
  texture.levels.push_back({width, height, Texels(texels.begin(), texels.end())});
  if (kind != TextureKind::kColor) {
    makeNormals(kind, texture);
    return texture;
  }
  texture.linear = linear;
  Texels& codes = texture.levels.front().texels;
  for (std::size_t i = 0; linear && i < codes.size(); i += 4)
    for (std::size_t c = 0; c < 3; ++c) codes[i + c] = srgb16OfLinear16()[codes[i + c]];
  buildMips(texture);
  return texture;
}

}  // namespace luciole
