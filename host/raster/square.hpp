#pragma once

#include <array>
#include <cstdint>

namespace luciole {

/// Pixels are resolved by squares of 4×4, side by side in the order in which a G-buffer stores them, so that
/// loops over a square's lanes become vector instructions.
constexpr int kSquareSize = 4;
constexpr int kSquarePixels = kSquareSize * kSquareSize;

template <class T>
using Lanes = std::array<T, kSquarePixels>;

/// The same for three components.
template <class T>
using Lanes3 = std::array<Lanes<T>, 3>;

/// Whether each pixel is meant: 0 or 1, as wide as the floats that it chooses.
using LaneMask = Lanes<std::int32_t>;

/// The way from a square's first pixel to each of its pixels.
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
