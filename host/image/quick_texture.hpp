#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include "luciole/texture.hpp"

namespace luciole {

/// The texture in a PNG or JPEG file's bytes, by libpng or libjpeg alone, without loading the module. Equals
/// the module's readTexture(). Empty for other files, for rare kinds (PNGs of 16 bits, interlaced or linear;
/// CMYK JPEGs), and for files with errors: the module reads these, or reports the error. `name` is for
/// messages. knows_space: use the file's colour space. Throws MachineError.
std::optional<Texture> readQuickly(std::span<const std::byte> file, const std::string& name,
                                   bool knows_space);

/// The same for a file.
std::optional<Texture> readQuickly(const std::string& path);

}  // namespace luciole
