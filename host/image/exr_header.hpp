#pragma once

#include <cstdint>
#include <string>

namespace luciole {

/// Walks through the headers of an OpenEXR file (other files pass) and throws InputError where one promises
/// what the file can't hold: the OpenEXR library makes room for an attribute, a preview, a tile or a table of
/// rows before it reads them. `name` is for the message; `largest_side` of the data window and of tiles, in
/// pixels.
void checkExrHeader(const std::string& path, const std::string& name, std::int64_t largest_side);

}  // namespace luciole
