#pragma once

#include <bit>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "luciole/array_memory.hpp"

// How the tree over a scene's triangles divides them: by the surface area heuristic (J. Goldsmith and J.
// Salmon, 1987) over bins (I. Wald, "On fast construction of SAH-based bounding volume hierarchies", 2007).
// Sets lie in two arrays in turns: a set is divided from one into the same range of the other, keeping the
// order. All on all cores, and the same whatever their number: what threads add up are counts and least
// values.
namespace luciole {

/// x, y, z and one more.
using Quad = float __attribute__((vector_size(16)));

inline Quad leastOf(Quad a, Quad b) { return a < b ? a : b; }

/// A box, by numbers that all become smaller where it grows. Empty as it is made.
struct QuadBox {
  Quad low = Quad{} + std::numeric_limits<float>::infinity();
  Quad minus_high = low;
  void add(const QuadBox& other) {
    low = leastOf(low, other.low);
    minus_high = leastOf(minus_high, other.minus_high);
  }
};

/// The sum of the areas of three sides that meet.
float halfArea(const QuadBox& box);

/// A triangle's box, whose low[3] holds the triangle's number: its bits, plus those of 2⁻⁶³, because denormal
/// numbers slow additions.
struct TriangleBox : QuadBox {
  void setNumber(std::uint32_t number) { low[3] = std::bit_cast<float>(number + kBias); }
  std::uint32_t number() const { return std::bit_cast<std::uint32_t>(float(low[3])) - kBias; }
  static constexpr std::uint32_t kBias = 0x20000000;
};

using TriangleBoxes = RawArray<TriangleBox>;

/// Triangles that lie together, from `begin` to before `end` of one of two arrays.
struct TriangleSet {
  QuadBox box;      ///< around their boxes
  QuadBox centres;  ///< around twice the boxes' centres
  std::uint32_t begin = 0, end = 0;
  int array = 0;
  std::uint32_t size() const { return end - begin; }
};

/// All of an array of boxes as a set. O(n).
TriangleSet wholeSet(const TriangleBoxes& boxes);

/// Blocks of kTreeWidth triangles that n need.
constexpr std::uint32_t blocksFor(std::uint32_t n) { return (n + 15) / 16; }

/// Divides a set of more than kTreeWidth triangles where area times blocks, summed over both parts, is least;
/// in halves where all centres coincide. O(n).
std::pair<TriangleSet, TriangleSet> splitByArea(const TriangleSet& set, TriangleBoxes (&arrays)[2]);

/// Divides a set of more than kTreeWidth triangles along the longest axis of their centres into parts of as
/// many blocks, or one more in the first, where all but the last block are full. O(n).
std::pair<TriangleSet, TriangleSet> splitInHalves(const TriangleSet& set, TriangleBoxes (&arrays)[2]);

}  // namespace luciole
