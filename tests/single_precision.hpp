#pragma once
/// Numbers that tests of single-precision arithmetic have in common.

#include <limits>

namespace luciole::test {

/// The relative error of one rounding in single precision, 2^-24.
inline constexpr double kUnit = 0x1p-24;
inline constexpr float kInfinity = std::numeric_limits<float>::infinity();
inline constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

}  // namespace luciole::test
