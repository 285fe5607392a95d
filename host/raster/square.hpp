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

/// Places that a square needs surfaces' coordinates at: its pixels, then the four pixels right of it and the
/// four below it, which the steps from pixel to pixel lead to.
constexpr int kSquarePlaces = kSquarePixels + 2 * kSquareSize;

template <class T>
using Places = std::array<T, kSquarePlaces>;

/// Where in a square's places pixel (x, y) lies, counted from the square's first; x or y may be kSquareSize.
constexpr int placeInSquare(int x, int y) {
  if (x == kSquareSize) return kSquarePixels + y;
  if (y == kSquareSize) return kSquarePixels + kSquareSize + x;
  return (x & 1) | (y & 1) << 1 | (x & 2) << 1 | (y & 2) << 2;
}

/// The way from a square's first pixel to each of its places, and the places next to each of its pixels.
struct SquareLayout {
  Places<int> x{};
  Places<int> y{};
  Lanes<int> right{};
  Lanes<int> below{};
};
constexpr SquareLayout squareLayout() {
  SquareLayout layout;
  for (int y = 0; y <= kSquareSize; ++y) {
    for (int x = 0; x <= kSquareSize; ++x) {
      if (x == kSquareSize && y == kSquareSize) continue;
      const int place = placeInSquare(x, y);
      layout.x[place] = x;
      layout.y[place] = y;
      if (place >= kSquarePixels) continue;
      layout.right[place] = placeInSquare(x + 1, y);
      layout.below[place] = placeInSquare(x, y + 1);
    }
  }
  return layout;
}
inline constexpr SquareLayout kSquareLayout = squareLayout();

}  // namespace luciole
