#include "shadow/exact/split_triangles.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "kernels/shared.h"

namespace luciole {
namespace {

constexpr std::uint32_t kMostBins = 32;
/// Triangles of a task. Smaller sets are divided by one thread.
constexpr std::uint32_t kChunk = 1 << 14;

using QuadInt = std::int32_t __attribute__((vector_size(16)));

/// A box's numbers as one vector: a bin then takes one load, one comparison and one store.
using BoxNumbers = float __attribute__((vector_size(sizeof(QuadBox))));
void addNumbers(const BoxNumbers& numbers, QuadBox& box) {
  BoxNumbers own;
  std::memcpy(&own, &box, sizeof own);
  own = own < numbers ? own : numbers;
  std::memcpy(static_cast<void*>(&box), &own, sizeof own);
}

struct SplitBins {
  std::array<std::array<QuadBox, kMostBins>, 3> box;
  std::array<std::array<std::uint32_t, kMostBins>, 3> count{};
};

/// Twice the centre of a box.
Quad centreOf(const TriangleBox& box) { return box.low - box.minus_high; }

/// Maps a centre c to a bin on each axis: ⌊(c − low) · scale⌋. That is less than `count`: `scale` has a
/// factor 1 − 2⁻²⁰, which exceeds the three roundings. An axis on which all centres lie too close has one
/// bin.
struct SplitGrid {
  std::uint32_t count;
  Quad low, scale;
  explicit SplitGrid(const TriangleSet& set)
      : count(std::min(4 + set.size() / 8, kMostBins)), low(set.centres.low), scale{} {
    for (int axis = 0; axis < 3; ++axis) {
      const float step =
          float(count) * (1 - 0x1p-20f) / -(set.centres.low[axis] + set.centres.minus_high[axis]);
      if (std::isfinite(step)) scale[axis] = step;
    }
  }
  int binOf(const TriangleBox& box, int axis) const {
    return int((box.low[axis] - box.minus_high[axis] - low[axis]) * scale[axis]);
  }
};

void addToBins(const SplitGrid& grid, const TriangleBox* box, const TriangleBox* end, SplitBins& bins) {
  for (; box < end; ++box) {
    const QuadInt place = __builtin_convertvector((centreOf(*box) - grid.low) * grid.scale, QuadInt);
    BoxNumbers numbers;
    std::memcpy(&numbers, box, sizeof numbers);
    for (int axis = 0; axis < 3; ++axis) {
      addNumbers(numbers, bins.box[axis][place[axis]]);
      ++bins.count[axis][place[axis]];
    }
  }
}

void joinBins(const SplitGrid& grid, const SplitBins& other, SplitBins& bins) {
  for (int axis = 0; axis < 3; ++axis)
    for (std::uint32_t i = 0; i < grid.count; ++i) {
      bins.box[axis][i].add(other.box[axis][i]);
      bins.count[axis][i] += other.count[axis][i];
    }
}

SplitBins fillBins(const SplitGrid& grid, const TriangleSet& set, const TriangleBox* boxes) {
  SplitBins bins;
  if (set.size() < 2 * kChunk) {
    addToBins(grid, boxes + set.begin, boxes + set.end, bins);
    return bins;
  }
  return tbb::parallel_reduce(
      tbb::blocked_range<std::uint32_t>(set.begin, set.end, kChunk), bins,
      [&](const auto& range, SplitBins some) {
        addToBins(grid, boxes + range.begin(), boxes + range.end(), some);
        return some;
      },
      [&](SplitBins some, const SplitBins& others) {
        joinBins(grid, others, some);
        return some;
      });
}

/// Between the bins `last` and last + 1 of an axis.
struct Split {
  float cost = std::numeric_limits<float>::infinity();
  int axis = -1;  ///< −1: none
  int last = 0;
  std::uint32_t left = 0;  ///< triangles before it
  QuadBox before, behind;
};

void findSplit(const SplitGrid& grid, const SplitBins& bins, int axis, Split& best) {
  const auto& box = bins.box[axis];
  const auto& count = bins.count[axis];
  std::array<QuadBox, kMostBins> behind;
  std::array<float, kMostBins> cost;  // of the bins after bin i
  QuadBox sum;
  std::uint32_t n = 0;
  for (std::uint32_t i = grid.count - 1; i > 0; --i) {
    sum.add(box[i]);
    n += count[i];
    behind[i - 1] = sum;
    cost[i - 1] = n == 0 ? std::numeric_limits<float>::infinity() : halfArea(sum) * float(blocksFor(n));
  }
  sum = {};
  n = 0;
  for (std::uint32_t i = 0; i + 1 < grid.count; ++i) {
    sum.add(box[i]);
    n += count[i];
    if (n == 0) continue;
    const float both = cost[i] + halfArea(sum) * float(blocksFor(n));
    if (both < best.cost) best = {both, axis, int(i), n, sum, behind[i]};
  }
}

/// Copies the boxes from `begin` to `end` to where `next` says for each side, and moves `next` on.
void scatter(const SplitGrid& grid, const Split& split, const TriangleBox* begin, const TriangleBox* end,
             std::array<TriangleBox*, 2> next, std::array<QuadBox, 2>& centres) {
  // All in registers: what a store by the side as an index leaves, the next triangle would wait for.
  auto [left, right] = next;
  QuadBox before, behind;
  const Quad nowhere = QuadBox{}.low;
  for (; begin < end; ++begin) {
    const int side = grid.binOf(*begin, split.axis) > split.last;
    *(side ? right : left) = *begin;
    right += side;
    left += 1 - side;
    const QuadInt is_behind = QuadInt{} - side;
    const Quad centre = centreOf(*begin), minus = -centre;
    before.add({is_behind ? nowhere : centre, is_behind ? nowhere : minus});
    behind.add({is_behind ? centre : nowhere, is_behind ? minus : nowhere});
  }
  centres[0].add(before);
  centres[1].add(behind);
}

/// The two parts in the other array, whose order is that of the set.
std::array<QuadBox, 2> divide(const SplitGrid& grid, const Split& split, const TriangleSet& set,
                              const TriangleBox* from, TriangleBox* to) {
  std::array<QuadBox, 2> centres;
  const std::uint32_t middle = set.begin + split.left;
  if (set.size() < 2 * kChunk) {
    scatter(grid, split, from + set.begin, from + set.end, {to + set.begin, to + middle}, centres);
    return centres;
  }
  const std::uint32_t chunks = (set.size() + kChunk - 1) / kChunk;
  const auto chunkBegin = [&](std::uint32_t chunk) {
    return from + std::min(set.begin + chunk * kChunk, set.end);
  };
  struct Chunk {
    std::uint32_t left = 0;
    std::array<QuadBox, 2> centres;
  };
  std::vector<Chunk, ArrayAllocator<Chunk>> parts(chunks);
  tbb::parallel_for(0u, chunks, [&](std::uint32_t i) {
    for (const TriangleBox* box = chunkBegin(i); box < chunkBegin(i + 1); ++box)
      parts[i].left += grid.binOf(*box, split.axis) <= split.last;
  });
  std::uint32_t left = 0;
  for (Chunk& part : parts) left += std::exchange(part.left, left);
  tbb::parallel_for(0u, chunks, [&](std::uint32_t i) {
    TriangleBox* const right = to + middle + i * kChunk - parts[i].left;
    scatter(grid, split, chunkBegin(i), chunkBegin(i + 1), {to + set.begin + parts[i].left, right},
            parts[i].centres);
  });
  for (const Chunk& part : parts)
    for (int side = 0; side < 2; ++side) centres[side].add(part.centres[side]);
  return centres;
}

QuadBox centresOf(const TriangleBox* begin, const TriangleBox* end, QuadBox& box) {
  QuadBox centres;
  for (; begin < end; ++begin) {
    box.add(*begin);
    centres.add({centreOf(*begin), -centreOf(*begin)});
  }
  return centres;
}

}  // namespace

float halfArea(const QuadBox& box) {
  const Quad side = -(box.low + box.minus_high);
  return side[0] * side[1] + side[1] * side[2] + side[2] * side[0];
}

TriangleSet wholeSet(const TriangleBoxes& boxes) {
  const std::uint32_t n = std::uint32_t(boxes.size());
  return tbb::parallel_reduce(
      tbb::blocked_range<std::uint32_t>(0, n, kChunk), TriangleSet{.box{}, .centres{}, .end = n},
      [&](const auto& range, TriangleSet set) {
        set.centres.add(centresOf(boxes.data() + range.begin(), boxes.data() + range.end(), set.box));
        return set;
      },
      [](TriangleSet a, const TriangleSet& b) {
        a.box.add(b.box);
        a.centres.add(b.centres);
        return a;
      });
}

std::pair<TriangleSet, TriangleSet> splitByArea(const TriangleSet& set, TriangleBoxes (&arrays)[2]) {
  const SplitGrid grid(set);
  const SplitBins bins = fillBins(grid, set, arrays[set.array].data());
  Split split;
  for (int axis = 0; axis < 3; ++axis) findSplit(grid, bins, axis, split);
  if (split.axis < 0) return splitInHalves(set, arrays);
  const auto centres = divide(grid, split, set, arrays[set.array].data(), arrays[1 - set.array].data());
  const std::uint32_t middle = set.begin + split.left;
  return {{split.before, centres[0], set.begin, middle, 1 - set.array},
          {split.behind, centres[1], middle, set.end, 1 - set.array}};
}

std::pair<TriangleSet, TriangleSet> splitInHalves(const TriangleSet& set, TriangleBoxes (&arrays)[2]) {
  int axis = 0;
  const Quad extent = -(set.centres.low + set.centres.minus_high);
  for (int i = 1; i < 3; ++i)
    if (extent[i] > extent[axis]) axis = i;
  TriangleBox* const boxes = arrays[set.array].data();
  const std::uint32_t middle = set.begin + (blocksFor(set.size()) + 1) / 2 * kTreeWidth;
  std::nth_element(boxes + set.begin, boxes + middle, boxes + set.end,
                   [axis](const TriangleBox& a, const TriangleBox& b) {
                     const float x = centreOf(a)[axis], y = centreOf(b)[axis];
                     return x != y ? x < y : a.number() < b.number();
                   });
  TriangleSet left{.box{}, .centres{}, .begin = set.begin, .end = middle, .array = set.array};
  TriangleSet right{.box{}, .centres{}, .begin = middle, .end = set.end, .array = set.array};
  left.centres = centresOf(boxes + left.begin, boxes + left.end, left.box);
  right.centres = centresOf(boxes + right.begin, boxes + right.end, right.box);
  return {left, right};
}

}  // namespace luciole
