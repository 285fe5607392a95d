#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "luciole/texture.hpp"

namespace luciole {

/// Reads a texture and builds its mip chain (box-filtered in linear light), from any format that OpenImageIO
/// reads, with one or at least three colour channels. Grey is spread over RGB, alpha is 1 where missing,
/// float pictures are clamped to [0,1] and sRGB-encoded. Throws InputError naming the file, or MachineError.
Texture readTexture(const std::string& path);

/// The same for a glTF file's image in memory. `name` is for messages. What the file says of its colour space
/// is ignored, as glTF wants it: codes of integers are sRGB.
Texture readTexture(std::span<const std::byte> file, const std::string& name);

}  // namespace luciole
