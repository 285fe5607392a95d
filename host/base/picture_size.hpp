#pragma once

namespace luciole {

/// Pixels a side of the largest picture that is made or read. Its edge functions fit 32 bits (see
/// raster/coverage.cpp), and all its pixels are 2³⁰.
inline constexpr int kLargestSide = 1 << 15;

}  // namespace luciole
