#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

namespace luciole {

/// The transfer function of IEC 61966-2-1, both ways. Decoding takes a code in [0,1].
inline double decodeSrgb(double code) {
  return code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4);
}
/// Clamps to [0,1]; NaN gives 0.
inline float encodeSrgb(float linear) {
  if (!(linear > 0.0f)) return 0.0f;
  if (linear >= 1.0f) return 1.0f;
  return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1.0f / 2.4f) - 0.055f;
}

/// Linear values of all 65536 16-bit sRGB codes (256 KiB, made at the first call). An 8-bit code c is the
/// 16-bit code 257 c.
const std::vector<float>& linearOfSrgb16();

/// The 16-bit sRGB codes of the linear numbers 0, 1/65535 … 1 (128 KiB, made at the first call).
const std::vector<std::uint16_t>& srgb16OfLinear16();

/// The linear value of a 16-bit code for its square root: about as fine as sRGB, and decoded by one product.
inline float linearOfRoot16(std::int32_t code) {
  const float root = float(code) * (1.0f / 65535.0f);
  return root * root;
}

}  // namespace luciole
