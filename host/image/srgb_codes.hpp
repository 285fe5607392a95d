#pragma once

#include <cstddef>
#include <cstdint>

namespace luciole {

/// The codes of linear values: Code(encodeSrgb(value) * M + threshold), M the largest code, for a threshold
/// of its own for each value, from 1/512 to 511/512. Some ten times as fast as that expression, in vectors,
/// and the same code for every value, NaN and infinities too.
void srgbCodes(const float* values, const float* thresholds, std::size_t count, std::uint8_t* codes);
void srgbCodes(const float* values, const float* thresholds, std::size_t count, std::uint16_t* codes);

}  // namespace luciole
