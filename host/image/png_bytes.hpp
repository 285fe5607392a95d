#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace luciole {

/// The bytes of a PNG of R G B codes, row by row from the top, for a file that holds pictures. Throws
/// MachineError where they don't fit into memory.
std::string pngBytes(int width, int height, std::span<const std::uint8_t> codes);

}  // namespace luciole
