#pragma once

namespace luciole {

/// Pixels a side of the largest picture that is made or read, so at most 2³⁰ pixels. Up to this size edge
/// functions fit 32 bits (see raster/coverage.cpp).
inline constexpr int kLargestSide = 1 << 15;

}  // namespace luciole
