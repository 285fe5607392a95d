#include "image/srgb_codes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "image/srgb.hpp"

namespace luciole {
namespace {

/// encodeSrgb() to within kSrgbError, without a call. Its power 1/2.4 is that of s = x^(1/4) to 5/3, which is
/// smooth where it counts: a polynomial through Chebyshev's nine points of s in [0.0031308^(1/4), 1], about
/// the middle of that, is within 1.3e-7 of it.
inline float fastSrgb(float linear) {
  const float above = linear > 0.0f ? linear : 0.0f;  // NaN too
  const float x = above < 1.0f ? above : 1.0f;
  const float t = std::sqrt(std::sqrt(x)) - 0.618272516f;
  float power = 0.0809201449f;
  for (const float next : {-0.0717047825f, 0.0412772819f, -0.0470950231f, 0.0668268055f, -0.123777956f,
                           0.687995315f, 1.27611065f, 0.418389946f})
    power = power * t + next;
  return x <= 0.0031308f ? 12.92f * x : power;
}

/// The polynomial's 1.3e-7; the rounding of its last steps, of values up to 1, 3 x 6e-8; that of the two
/// roots, 5/3 x 4.5e-8; and two units in the last place, 1.2e-7, for std::pow.
constexpr float kSrgbError = 6e-7f;

/// Blocks in which the values that need a closer look are looked for.
constexpr std::size_t kBlock = 64;

template <class Code>
void encode(const float* values, const float* thresholds, std::size_t count, Code* codes) {
  constexpr float kLargest = float(std::numeric_limits<Code>::max());
  // Product and sum round too, both here and in what this is to agree with.
  constexpr float kUnsure = kSrgbError * kLargest + 4 * 0x1p-24f * (kLargest + 1);
  const auto at = [&](std::size_t first, std::size_t size) {
    std::array<std::uint8_t, kBlock> is_unsure;
    std::uint8_t any = 0;
    for (std::size_t i = 0; i < size; ++i) {
      const float place = fastSrgb(values[first + i]) * kLargest + thresholds[first + i];
      const std::int32_t code = std::int32_t(place);
      const float beyond = place - float(code);
      codes[first + i] = Code(code);
      is_unsure[i] = std::uint8_t((beyond < kUnsure) | (beyond > 1.0f - kUnsure));
      any |= is_unsure[i];
    }
    if (!any) return;
    for (std::size_t i = first; i < first + size; ++i)
      if (is_unsure[i - first]) codes[i] = Code(encodeSrgb(values[i]) * kLargest + thresholds[i]);
  };
  const std::size_t whole = count - count % kBlock;
  for (std::size_t first = 0; first < whole; first += kBlock) at(first, kBlock);
  at(whole, count - whole);
}

}  // namespace

void srgbCodes(const float* values, const float* thresholds, std::size_t count, std::uint8_t* codes) {
  encode(values, thresholds, count, codes);
}

void srgbCodes(const float* values, const float* thresholds, std::size_t count, std::uint16_t* codes) {
  encode(values, thresholds, count, codes);
}

}  // namespace luciole
