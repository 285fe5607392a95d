#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include "luciole/texture.hpp"

namespace luciole {

/// The texture in a PNG or JPEG file's bytes, by libpng or libjpeg alone: what the module's readTexture()
/// makes of it, without loading the module. Empty for any other file, for the rarer kinds of these two (PNGs
/// of 16 bits, interlaced or linear; JPEGs for print) and for one that the library doesn't read: the module
/// reads them, or says what is wrong. `name` is for messages. knows_space: whether what the file says of its
/// colour space counts. Throws MachineError.
std::optional<Texture> readQuickly(std::span<const std::byte> file, const std::string& name,
                                   bool knows_space);

/// The same for a file.
std::optional<Texture> readQuickly(const std::string& path);

}  // namespace luciole
