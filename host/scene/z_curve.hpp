#pragma once

#include <cstdint>

namespace luciole {

/// Spreads bits 0 to 20 of v to bits 0, 3, 6 …: one coordinate's bits of a Morton code (G. Morton, 1966).
inline std::uint64_t everyThirdBit(std::uint64_t v) {
  v = (v | v << 32) & 0x001f00000000ffff;
  v = (v | v << 16) & 0x001f0000ff0000ff;
  v = (v | v << 8) & 0x100f00f00f00f00f;
  v = (v | v << 4) & 0x10c30c30c30c30c3;
  return (v | v << 2) & 0x1249249249249249;
}

}  // namespace luciole
