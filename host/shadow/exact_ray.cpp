#include "shadow/exact_ray.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "kernels/exact_sign.h"

namespace luciole {
namespace {

/// The points from + t · way, 0 ≤ t ≤ most, on which a triangle that blocks has a point: from the light to
/// the start, or from the start to a light at infinity.
struct Line {
  glm::dvec3 from, way;
  double most;
};

struct Pair {
  glm::vec3 start;
  float4 light;
  bool at_infinity;
};

Line lineOf(const Pair& pair) {
  const glm::dvec3 light(pair.light.x, pair.light.y, pair.light.z), start(pair.start);
  if (pair.at_infinity) return {start, light, std::numeric_limits<double>::infinity()};
  return {light, start - light, 1};
}

/// Bit i: the line may meet the box of child i. No box that it meets is left out: t has three roundings on
/// its way (a difference, the reciprocal, the product; `way` may have a fourth), each below 2⁻⁵³ of it. So
/// the greatest t at which the line enters a slab, and the least at which it leaves one, are right to 2⁻⁵⁰ of
/// themselves, and 2⁻⁴⁹ is allowed for either.
std::uint32_t childrenOn(const Line& line, const float* box) {
  std::array<double, kTreeWidth> enter, leave;
  std::array<int, kTreeWidth> meets;
  enter.fill(0);
  leave.fill(line.most);
  for (int i = 0; i < kTreeWidth; ++i) meets[i] = box[i] <= box[kTreeWidth + i];
  for (int axis = 0; axis < 3; ++axis) {
    const float* const low = box + 2 * axis * kTreeWidth;
    const float* const high = low + kTreeWidth;
    const double from = line.from[axis], way = line.way[axis];
    if (way == 0) {
      for (int i = 0; i < kTreeWidth; ++i) meets[i] &= (low[i] <= from) & (from <= high[i]);
      continue;
    }
    const float* const first = way > 0 ? low : high;
    const float* const last = way > 0 ? high : low;
    const double inverse = 1 / way;
    for (int i = 0; i < kTreeWidth; ++i) {
      enter[i] = std::max(enter[i], (double(first[i]) - from) * inverse);
      leave[i] = std::min(leave[i], (double(last[i]) - from) * inverse);
    }
  }
  std::uint32_t bits = 0;
  for (int i = 0; i < kTreeWidth; ++i) {
    const double beyond = enter[i] - leave[i], allowed = 0x1p-49 * (std::abs(enter[i]) + std::abs(leave[i]));
    bits |= std::uint32_t(meets[i] & ((beyond <= 0) | (beyond <= allowed))) << i;
  }
  return bits;
}

/// How far the start lies from the planes of a block's triangles, on the side that their normals point to.
std::array<float, kTreeWidth> heightsOver(const float* planes, const glm::vec3& start) {
  std::array<float, kTreeWidth> heights;
  for (int i = 0; i < kTreeWidth; ++i)
    heights[i] =
        std::fma(planes[i], start.x,
                 std::fma(planes[kTreeWidth + i], start.y,
                          std::fma(planes[2 * kTreeWidth + i], start.z, -planes[3 * kTreeWidth + i])));
  return heights;
}

float4 cornerOf(const float* block, int corner, int slot) {
  const float* const rows = block + (kCornerRows + 3 * corner) * kTreeWidth + slot;
  return {rows[0], rows[kTreeWidth], rows[2 * kTreeWidth], 0};
}

/// The sign of the volume between p, q, r and the light: the side of the light on which these three turn.
int sideOf(const Pair& pair, const float4& p, const float4& q, const float4& r) {
  return pair.at_infinity ? orientation_along(q, r, p, pair.light) : orientation(p, q, r, pair.light);
}

/// Whether the start lies behind the triangle, which isn't seen edge-on from the light, in its cone, or on
/// the cone's rim.
bool isInCone(const Pair& pair, const std::array<float4, 3>& corners, int side) {
  const float4 start{pair.start.x, pair.start.y, pair.start.z, 0};
  for (int i = 0; i < 3; ++i) {
    const float4 &p = corners[i], &q = corners[(i + 1) % 3];
    const int sign =
        pair.at_infinity ? orientation_along(p, q, start, pair.light) : orientation(p, q, start, pair.light);
    if (sign * side < 0) return false;
  }
  return true;
}

/// The weights of the corners where the line meets the triangle: each is the volume between light, start and
/// the other two corners, as in kernels/blockers.clh: without loss for a small triangle far from the light.
glm::dvec3 weightsOf(const Pair& pair, const std::array<float4, 3>& corners) {
  const Line line = lineOf(pair);
  std::array<glm::dvec3, 3> from;
  for (int i = 0; i < 3; ++i) from[i] = glm::dvec3(corners[i].x, corners[i].y, corners[i].z) - line.from;
  glm::dvec3 weights;
  for (int i = 0; i < 3; ++i) {
    const glm::dvec3 &x = from[(i + 1) % 3], &y = from[(i + 2) % 3];
    weights[i] = glm::dot(glm::cross(x + y, y - x), line.way);
  }
  // All have the sign of the largest, or it is rounding's.
  const double sum = weights.x + weights.y + weights.z;
  weights = glm::max(sum < 0 ? -weights : weights, glm::dvec3(0));
  const double total = weights.x + weights.y + weights.z;
  return total > 0 ? weights / total : glm::dvec3(1.0 / 3);
}

bool blocks(const TriangleTree& tree, std::size_t block, const Pair& pair, const HoleTest& is_hole) {
  const float* const rows = &tree.blocks[block * kBlockRows * kTreeWidth];
  const std::array<float, kTreeWidth> heights = heightsOver(rows + int(kPlaneRows) * kTreeWidth, pair.start);
  const float error =
      POINT_ERROR * ((std::abs(pair.start.x) + std::abs(pair.start.y)) + std::abs(pair.start.z));
  const float4 start{pair.start.x, pair.start.y, pair.start.z, 0};
  const std::uint32_t bits = tree.block_bits[block];
  for (int slot = 0; slot < kTreeWidth; ++slot) {
    const float own = rows[int(kRoundingRow) * kTreeWidth + slot];
    if ((bits >> slot & 1) == 0 || !(std::abs(heights[slot]) > std::max(error, own))) continue;
    const std::array<float4, 3> corners{cornerOf(rows, 0, slot), cornerOf(rows, 1, slot),
                                        cornerOf(rows, 2, slot)};
    const int side = sideOf(pair, corners[0], corners[1], corners[2]);
    if (side == 0 || side != (heights[slot] > 0 ? 1 : -1) || !isInCone(pair, corners, side) ||
        orientation(corners[0], corners[1], corners[2], start) == side)
      continue;
    if ((bits >> (16 + slot) & 1) != 0 &&
        is_hole(tree.triangles[block * kTreeWidth + slot], weightsOf(pair, corners)))
      continue;
    return true;
  }
  return false;
}

}  // namespace

bool isBlocked(const TriangleTree& tree, const glm::vec3& start, const BeamLight& light,
               const HoleTest& is_hole) {
  const Pair pair{start, light.place, light.place.w == 0};
  const Line line = lineOf(pair);
  if (line.way == glm::dvec3(0)) return false;
  std::array<int, kMaxTreeDepth*(kTreeWidth - 1) + 1> stack;
  int size = 0;
  stack[size++] = tree.root;
  while (size > 0) {
    const int reference = stack[--size];
    if (reference < 0) {
      if (blocks(tree, ~reference, pair, is_hole)) return true;
      continue;
    }
    const std::size_t node = std::size_t(reference);
    for (std::uint32_t bits = childrenOn(line, &tree.nodes[node * kNodeRows * kTreeWidth]); bits != 0;
         bits &= bits - 1)
      stack[size++] = tree.children[node * kTreeWidth + std::size_t(std::countr_zero(bits))];
  }
  return false;
}

}  // namespace luciole
