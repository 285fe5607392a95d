#pragma once

#include <cstddef>
#include <cstdint>

namespace luciole {

/// A code as 16 bits: of 8 bits, code × 257.
inline std::uint16_t wideCode(std::uint8_t code) { return std::uint16_t(code * 257); }
inline std::uint16_t wideCode(std::uint16_t code) { return code; }

template <int kChannels, class Code>
void spreadTexelsOf(const Code* codes, std::size_t count, std::uint16_t* __restrict texels) {
  for (std::size_t i = 0; i < count; ++i, codes += kChannels, texels += 4) {
    texels[0] = wideCode(codes[0]);
    texels[1] = kChannels < 3 ? texels[0] : wideCode(codes[1]);
    texels[2] = kChannels < 3 ? texels[0] : wideCode(codes[2]);
    texels[3] = kChannels % 2 ? 65535 : wideCode(codes[kChannels - 1]);
  }
}

/// Writes `count` pixels of 1 to 4 channels (grey, grey and alpha, R G B, R G B A), codes of 8 or 16 bits, as
/// texels of R G B A. Alpha is 1 where missing.
template <class Code>
void spreadTexels(const Code* codes, std::size_t count, int channels, std::uint16_t* texels) {
  switch (channels) {
    case 1:
      return spreadTexelsOf<1>(codes, count, texels);
    case 2:
      return spreadTexelsOf<2>(codes, count, texels);
    case 3:
      return spreadTexelsOf<3>(codes, count, texels);
    default:
      return spreadTexelsOf<4>(codes, count, texels);
  }
}

}  // namespace luciole
