#include "shadow/exact/exact_ray.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "kernels/exact/exact_sign.h"
#include "shadow/exact/light_samples.hpp"

namespace luciole {
namespace {

constexpr int kLanes = kTreeWidth;
using Lane = std::array<double, kLanes>;
/// Vectors, a lane each.
using Lanes3 = std::array<Lane, 3>;

/// The lights, as seen from the start.
struct Lights {
  glm::vec3 start;
  std::span<const float4> place;
  bool at_infinity;
  /// The way to each from the start, or the direction: rows of kLanes. Lanes without a light are like the
  /// first one.
  std::array<Lanes3, kMostSoftSamples / kLanes> ways;
  std::array<std::uint32_t, kMostSoftSamples / kLanes>
      left;  ///< bits of those that nothing is known to block
  std::size_t rows;
  glm::dvec3 low, high;            ///< bounds of all ways
  glm::dvec3 middle, half_widths;  ///< the same box, rounded outwards
};

/// The ways are differences of floats, right to 2⁻⁵³ of themselves.
void see(const glm::vec3& start, std::span<const float4> places, Lights& lights) {
  lights.start = start;
  lights.place = places;
  lights.at_infinity = places[0].w == 0;
  lights.rows = (places.size() + kLanes - 1) / kLanes;
  lights.low = glm::dvec3(std::numeric_limits<double>::infinity());
  lights.high = -lights.low;
  const glm::dvec3 from = lights.at_infinity ? glm::dvec3(0) : glm::dvec3(start);
  for (std::size_t row = 0; row < lights.rows; ++row) {
    const std::size_t first = row * kLanes, count = std::min<std::size_t>(places.size() - first, kLanes);
    for (std::size_t i = 0; i < kLanes; ++i) {
      const float4& place = places[i < count ? first + i : 0];
      const glm::dvec3 way = glm::dvec3(place.x, place.y, place.z) - from;
      for (int axis = 0; axis < 3; ++axis) lights.ways[row][axis][i] = way[axis];
      lights.low = glm::min(lights.low, way);
      lights.high = glm::max(lights.high, way);
    }
    lights.left[row] = (1u << count) - 1;
  }
  lights.low -= 0x1p-50 * glm::abs(lights.low);
  lights.high += 0x1p-50 * glm::abs(lights.high);
  lights.middle = 0.5 * (lights.low + lights.high);
  lights.half_widths =
      0.5 * (lights.high - lights.low) + 0x1p-50 * (glm::abs(lights.low) + glm::abs(lights.high));
}

std::uint32_t bitsOf(const std::array<int, kLanes>& lanes) {
  std::uint32_t bits = 0;
  for (int i = 0; i < kLanes; ++i) bits |= std::uint32_t(lanes[i]) << i;
  return bits;
}

/// Bit i: child i's box may meet the hull of the start and the lights: the places start + t·way, 0 ≤ t ≤ 1,
/// without an end for lights at infinity, of all ways between `low` and `high`. No box that it meets is left
/// out: t has three roundings on its way (a difference, the reciprocal, the product; `low` and `high` have
/// theirs outwards), each below 2⁻⁵³ of it. So the greatest t at which the hull has come to a slab, and the
/// least at which it has left one, are right to 2⁻⁵⁰ of themselves, and 2⁻⁴⁹ is allowed for either.
std::uint32_t childrenIn(const Lights& lights, const float* box) {
  Lane enter, leave;
  std::array<int, kLanes> meets;
  enter.fill(0);
  leave.fill(lights.at_infinity ? std::numeric_limits<double>::infinity() : 1);
  for (int i = 0; i < kLanes; ++i) meets[i] = box[i] <= box[kLanes + i];
  // t·way ≥ bound − from, of boxes' lower bounds and the highest ways; turned around for the others.
  const auto cut = [&](const float* bounds, double from, double way, double sign) {
    if (way == 0) {
      for (int i = 0; i < kLanes; ++i) meets[i] &= sign * (double(bounds[i]) - from) <= 0;
      return;
    }
    const double inverse = 1 / way;
    if (sign * way > 0) {
      for (int i = 0; i < kLanes; ++i) enter[i] = std::max(enter[i], (double(bounds[i]) - from) * inverse);
    } else {
      for (int i = 0; i < kLanes; ++i) leave[i] = std::min(leave[i], (double(bounds[i]) - from) * inverse);
    }
  };
  for (int axis = 0; axis < 3; ++axis) {
    const float* const bounds = box + 2 * axis * kLanes;
    cut(bounds, lights.start[axis], lights.high[axis], 1);
    cut(bounds + kLanes, lights.start[axis], lights.low[axis], -1);
  }
  for (int i = 0; i < kLanes; ++i) {
    const double beyond = enter[i] - leave[i], allowed = 0x1p-49 * (std::abs(enter[i]) + std::abs(leave[i]));
    meets[i] &= (beyond <= 0) | (beyond <= allowed);
  }
  return bitsOf(meets);
}

/// How far the start lies from the planes of a block's triangles, on the side that their normals point to.
std::array<float, kLanes> heightsOver(const float* planes, const glm::vec3& start) {
  std::array<float, kLanes> heights;
  for (int i = 0; i < kLanes; ++i)
    heights[i] = std::fma(planes[i], start.x,
                          std::fma(planes[kLanes + i], start.y,
                                   std::fma(planes[2 * kLanes + i], start.z, -planes[3 * kLanes + i])));
  return heights;
}

float4 cornerOf(const float* block, int corner, int slot) {
  const float* const rows = block + (kCornerRows + 3 * corner) * kLanes + slot;
  return {rows[0], rows[kLanes], rows[2 * kLanes], 0};
}

/// The sign of the volume between p, q, r and the light: the side of the light on which these three turn.
int sideOf(const float4& light, bool at_infinity, const float4& p, const float4& q, const float4& r) {
  return at_infinity ? orientation_along(q, r, p, light) : orientation(p, q, r, light);
}

/// Whether the start lies behind the triangle, which isn't seen edge-on from the light and has that side of
/// it, in its cone, or on the cone's rim.
bool isInCone(const float4& light, bool at_infinity, const std::array<float4, 3>& corners,
              const glm::vec3& at, int side) {
  if (sideOf(light, at_infinity, corners[0], corners[1], corners[2]) != side) return false;
  const float4 start{at.x, at.y, at.z, 0};
  for (int i = 0; i < 3; ++i)
    if (sideOf(light, at_infinity, start, corners[i], corners[(i + 1) % 3]) * side < 0) return false;
  return true;
}

/// The weights of the corners where the ray meets the triangle: each is the volume between light, start and
/// the other two corners, as in kernels/exact/blockers.clh: without loss for a small triangle far from the
/// light.
glm::dvec3 weightsOf(const Lights& lights, const float4& light, const std::array<float4, 3>& corners) {
  const glm::dvec3 place(light.x, light.y, light.z), start(lights.start);
  const glm::dvec3 origin = lights.at_infinity ? start : place,
                   along = lights.at_infinity ? place : start - place;
  std::array<glm::dvec3, 3> from;
  for (int i = 0; i < 3; ++i) from[i] = glm::dvec3(corners[i].x, corners[i].y, corners[i].z) - origin;
  glm::dvec3 weights;
  for (int i = 0; i < 3; ++i) {
    const glm::dvec3 &x = from[(i + 1) % 3], &y = from[(i + 2) % 3];
    weights[i] = glm::dot(glm::cross(x + y, y - x), along);
  }
  // All have the sign of the largest, or it is rounding's.
  const double sum = weights.x + weights.y + weights.z;
  weights = glm::max(sum < 0 ? -weights : weights, glm::dvec3(0));
  const double total = weights.x + weights.y + weights.z;
  return total > 0 ? weights / total : glm::dvec3(1.0 / 3);
}

/// The signs of determinants, as functions of the way s to a light, with corners relative to the start and
/// σ the side on which the start is: a triangle of that side blocks if
///   Mᵢ·s ≥ 0 of each edge xy, Mᵢ = −σ·x × y, and σ·V + ΣMᵢ·s > 0, V = det(a, b, c); without V at infinity.
/// These are σ times the determinants of kernels/exact/exact_sign.h, expanded at the start. In double
/// precision, u = 2⁻⁵³, each has products of three factors: of differences that round by u and are at most
/// `most` in corners and `far` in s, with up to 10 roundings in all. Mᵢ·s has 6 products and the other
/// sum 24. So they are off by less than 2⁻⁴⁷·most²·far and 2⁻⁴⁴·most²·(most + far). A float that a device
/// takes for 0 is none here.
struct Volumes {
  glm::dvec3 edge[3], all;
  double start, edge_error, all_error;
};

Volumes volumesOf(const Lights& lights, const std::array<float4, 3>& corners, int side) {
  Volumes volumes;
  glm::dvec3 from[3];
  for (int i = 0; i < 3; ++i)
    from[i] = glm::dvec3(corners[i].x, corners[i].y, corners[i].z) - glm::dvec3(lights.start);
  const glm::dvec3 sizes = glm::max(glm::abs(from[0]), glm::max(glm::abs(from[1]), glm::abs(from[2])));
  const glm::dvec3 ways = glm::max(glm::abs(lights.low), glm::abs(lights.high));
  const double most = std::max({sizes.x, sizes.y, sizes.z}), far = std::max({ways.x, ways.y, ways.z});
  for (int i = 0; i < 3; ++i) volumes.edge[i] = -double(side) * glm::cross(from[i], from[(i + 1) % 3]);
  volumes.all = volumes.edge[0] + volumes.edge[1] + volumes.edge[2];
  volumes.start = lights.at_infinity ? 0 : -glm::dot(volumes.edge[0], from[2]);
  volumes.edge_error = 0x1p-47 * most * most * far;
  volumes.all_error = 0x1p-44 * most * most * (most + far);
  return volumes;
}

/// Bits of a block's triangles that may block a light. heights: of the start over their planes. All numbers
/// are those of Volumes, and what is within the box of ways is added to their errors.
std::uint32_t trianglesIn(const Lights& lights, const float* rows, const std::array<float, kLanes>& heights) {
  const glm::dvec3 start(lights.start), middle = lights.middle, half = lights.half_widths;
  const double far =
      std::max({std::abs(middle.x) + half.x, std::abs(middle.y) + half.y, std::abs(middle.z) + half.z});
  const double volume = lights.at_infinity ? 0 : 1;
  std::array<int, kLanes> may;
  for (int i = 0; i < kLanes; ++i) {
    const auto at = [&](int corner, int axis) {
      return double(rows[(kCornerRows + 3 * corner + axis) * kLanes + i]) - start[axis];
    };
    const double ax = at(0, 0), ay = at(0, 1), az = at(0, 2), bx = at(1, 0), by = at(1, 1), bz = at(1, 2),
                 cx = at(2, 0), cy = at(2, 1), cz = at(2, 2);
    const double turn = heights[i] > 0 ? -1.0 : 1.0;
    const double px = turn * (ay * bz - az * by), py = turn * (az * bx - ax * bz),
                 pz = turn * (ax * by - ay * bx);
    const double qx = turn * (by * cz - bz * cy), qy = turn * (bz * cx - bx * cz),
                 qz = turn * (bx * cy - by * cx);
    const double rx = turn * (cy * az - cz * ay), ry = turn * (cz * ax - cx * az),
                 rz = turn * (cx * ay - cy * ax);
    const auto most = [&](double x, double y, double z) {
      return x * middle.x + y * middle.y + z * middle.z + std::abs(x) * half.x + std::abs(y) * half.y +
             std::abs(z) * half.z;
    };
    const double size = std::max({std::abs(ax), std::abs(ay), std::abs(az), std::abs(bx), std::abs(by),
                                  std::abs(bz), std::abs(cx), std::abs(cy), std::abs(cz)});
    const double least = std::min({most(px, py, pz), most(qx, qy, qz), most(rx, ry, rz)});
    const double all =
        most(px + qx + rx, py + qy + ry, pz + qz + rz) - volume * (px * cx + py * cy + pz * cz);
    may[i] = (least >= -0x1p-46 * size * size * far) & (all >= -0x1p-43 * size * size * (size + far));
  }
  return bitsOf(may);
}

/// Takes from the lights that are left those that a triangle blocks. height: of the start over its plane.
/// Returns whether it blocks any.
bool block(const TriangleTree& tree, std::size_t block, int slot, float height, const HoleTest& is_hole,
           Lights& lights) {
  const float* const rows = &tree.blocks[block * kBlockRows * kLanes];
  const std::array<float4, 3> corners{cornerOf(rows, 0, slot), cornerOf(rows, 1, slot),
                                      cornerOf(rows, 2, slot)};
  const int side = height > 0 ? 1 : -1;
  if (orientation(corners[0], corners[1], corners[2], {lights.start.x, lights.start.y, lights.start.z, 0}) ==
      side)
    return false;
  const Volumes volumes = volumesOf(lights, corners, side);
  const bool hollow = (tree.block_bits[block] >> (16 + slot) & 1) != 0;
  bool any = false;
  for (std::size_t row = 0; row < lights.rows; ++row) {
    if (lights.left[row] == 0) continue;
    const Lanes3& ways = lights.ways[row];
    std::array<int, kLanes> may, certain;
    for (int i = 0; i < kLanes; ++i) {
      const auto along = [&](const glm::dvec3& m) {
        return m.x * ways[0][i] + m.y * ways[1][i] + m.z * ways[2][i];
      };
      const double edges = std::min({along(volumes.edge[0]), along(volumes.edge[1]), along(volumes.edge[2])});
      const double all = volumes.start + along(volumes.all);
      may[i] = (edges >= -volumes.edge_error) & (all >= -volumes.all_error);
      certain[i] = (edges > volumes.edge_error) & (all > volumes.all_error);
    }
    const std::uint32_t sure = bitsOf(certain) & lights.left[row];
    std::uint32_t blocked = bitsOf(may) & lights.left[row];
    for (std::uint32_t left = hollow ? blocked : blocked & ~sure; left != 0; left &= left - 1) {
      const int bit = std::countr_zero(left);
      const float4& light = lights.place[row * kLanes + std::size_t(bit)];
      const bool hides =
          (sure >> bit & 1) != 0 || isInCone(light, lights.at_infinity, corners, lights.start, side);
      if (!hides || (hollow && is_hole(tree.triangles[block * kLanes + std::size_t(slot)],
                                       weightsOf(lights, light, corners))))
        blocked &= ~(1u << bit);
    }
    lights.left[row] &= ~blocked;
    any |= blocked != 0;
  }
  return any;
}

/// The same for all triangles of a block.
bool blockAll(const TriangleTree& tree, std::size_t number, const HoleTest& is_hole, Lights& lights) {
  const float* const rows = &tree.blocks[number * kBlockRows * kLanes];
  const glm::vec3& start = lights.start;
  const std::array<float, kLanes> heights = heightsOver(rows + int(kPlaneRows) * kLanes, start);
  const float error = POINT_ERROR * ((std::abs(start.x) + std::abs(start.y)) + std::abs(start.z));
  std::array<int, kLanes> beyond;
  for (int i = 0; i < kLanes; ++i)
    beyond[i] = std::abs(heights[i]) > std::max(error, rows[int(kRoundingRow) * kLanes + i]);
  std::uint32_t bits = bitsOf(beyond) & tree.block_bits[number] & 0xffff;
  if (bits != 0) bits &= trianglesIn(lights, rows, heights);
  bool any = false;
  for (; bits != 0; bits &= bits - 1) {
    const int slot = std::countr_zero(bits);
    any |= block(tree, number, slot, heights[slot], is_hole, lights);
  }
  return any;
}

std::size_t countLeft(const Lights& lights) {
  std::size_t count = 0;
  for (std::size_t row = 0; row < lights.rows; ++row) count += std::size_t(std::popcount(lights.left[row]));
  return count;
}

}  // namespace

std::size_t countUnblocked(const TriangleTree& tree, const glm::vec3& start, std::span<const float4> places,
                           const HoleTest& is_hole, std::optional<std::size_t>& likely) {
  Lights lights;
  see(start, places, lights);
  const std::optional<std::size_t> asked = likely;
  if (asked && blockAll(tree, *asked, is_hole, lights) && countLeft(lights) == 0) return 0;
  std::array<int, kMaxTreeDepth*(kLanes - 1) + 1> stack;
  int size = 0;
  stack[size++] = tree.root;
  while (size > 0) {
    const int reference = stack[--size];
    if (reference < 0) {
      const std::size_t number = ~unsigned(reference);
      if (asked == number || !blockAll(tree, number, is_hole, lights)) continue;
      likely = number;
      if (countLeft(lights) == 0) return 0;
      continue;
    }
    const auto node = std::size_t(reference);
    for (std::uint32_t bits = childrenIn(lights, &tree.nodes[node * kNodeRows * kLanes]); bits != 0;
         bits &= bits - 1)
      stack[size++] = tree.children[node * kLanes + std::size_t(std::countr_zero(bits))];
  }
  return countLeft(lights);
}

bool isBlocked(const TriangleTree& tree, const glm::vec3& start, const BeamLight& light,
               const HoleTest& is_hole) {
  std::optional<std::size_t> likely;
  return countUnblocked(tree, start, {&light.place, 1}, is_hole, likely) == 0;
}

}  // namespace luciole
