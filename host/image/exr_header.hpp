#pragma once

#include <cstdint>
#include <string>

namespace luciole {

/// Checks the headers of an OpenEXR file; other files pass. Throws InputError if a header has sizes that the
/// file can't hold: the OpenEXR library allocates memory for attributes, previews, tiles and tables of rows
/// before it reads them. `name` is for the message. `largest_side`: limit for the sides of the data window
/// and of tiles, pixels.
void checkExrHeader(const std::string& path, const std::string& name, std::int64_t largest_side);

}  // namespace luciole
