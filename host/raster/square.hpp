#pragma once

#include <array>
#include <cstdint>

namespace luciole {

/// Pixels are resolved in squares of 4×4, which are contiguous in a G-buffer's planes. Loops over a square's
/// pixels (lanes), in the order of the planes, are vectorized.
constexpr int kSquareSize = 4;
constexpr int kSquarePixels = kSquareSize * kSquareSize;

template <class T>
using Lanes = std::array<T, kSquarePixels>;

/// The same for three components.
template <class T>
using Lanes3 = std::array<Lanes<T>, 3>;

/// A choice of pixels: 0 or 1 each, as wide as the floats that it selects, for vectorized loops.
using LaneMask = Lanes<std::int32_t>;

/// Copies the values of the pixels in `mask`.
template <class T>
void copyLanes(const Lanes<T>& values, const LaneMask& mask, Lanes<T>& out) {
  for (int i = 0; i < kSquarePixels; ++i) out[i] = mask[i] ? values[i] : out[i];
}

/// Offsets from a square's first pixel to each of its pixels, in Z order.
struct SquareLayout {
  Lanes<int> x{};
  Lanes<int> y{};
};
constexpr SquareLayout squareLayout() {
  SquareLayout layout;
  for (int i = 0; i < kSquarePixels; ++i) {
    layout.x[i] = (i & 1) | (i >> 1 & 2);
    layout.y[i] = (i >> 1 & 1) | (i >> 2 & 2);
  }
  return layout;
}
inline constexpr SquareLayout kSquareLayout = squareLayout();

}  // namespace luciole
