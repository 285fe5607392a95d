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
  /// From the start to each light, or towards a directional one; rows of kLanes. Unused lanes repeat the
  /// first light.
  std::array<Lanes3, kMostSoftSamples / kLanes> directions;
  /// A bit for each light, clear once a triangle is known to block it.
  std::array<std::uint32_t, kMostSoftSamples / kLanes> unblocked;
  std::size_t rows;
  glm::dvec3 low, high;            ///< bounds of all directions
  glm::dvec3 middle, half_widths;  ///< the same box, rounded outwards
};

/// Sets the directions, differences of floats that are right to 2⁻⁵³ of themselves, and their bounds. Sets
/// all lights unblocked.
void setLights(const glm::vec3& start, std::span<const float4> places, Lights& lights) {
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
      const glm::dvec3 direction = glm::dvec3(place.x, place.y, place.z) - from;
      for (int axis = 0; axis < 3; ++axis) lights.directions[row][axis][i] = direction[axis];
      lights.low = glm::min(lights.low, direction);
      lights.high = glm::max(lights.high, direction);
    }
    lights.unblocked[row] = (1u << count) - 1;
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

/// Bit i is set if child i's box may intersect the hull of the start and the lights: the points
/// start + t·direction for all directions between `low` and `high`, with 0 ≤ t ≤ 1, or t ≥ 0 for lights at
/// infinity. This is the slab test of rays, for an interval of directions. It is conservative: t has three
/// roundings (a difference, the reciprocal, the product; `low` and `high` are rounded outwards), each below
/// 2⁻⁵³ of it. So the greatest t at which the hull enters a slab, and the least at which it leaves one, are
/// right to 2⁻⁵⁰ of themselves, and 2⁻⁴⁹ is allowed for either.
std::uint32_t childrenIn(const Lights& lights, const float* box) {
  Lane enter, leave;
  std::array<int, kLanes> meets;
  enter.fill(0);
  leave.fill(lights.at_infinity ? std::numeric_limits<double>::infinity() : 1);
  for (int i = 0; i < kLanes; ++i) meets[i] = box[i] <= box[kLanes + i];
  // t·direction ≥ bound − from, for lower bounds and the highest direction; sign = −1 for the opposite.
  const auto cut = [&](const float* bounds, double from, double direction, double sign) {
    if (direction == 0) {
      for (int i = 0; i < kLanes; ++i) meets[i] &= sign * (double(bounds[i]) - from) <= 0;
      return;
    }
    const double inverse = 1 / direction;
    if (sign * direction > 0) {
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

/// Signed distances of the start from the planes of a block's triangles, positive on the normals' side.
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

/// The sign of the volume of the tetrahedron of p, q, r and the light.
int sideOf(const float4& light, bool at_infinity, const float4& p, const float4& q, const float4& r) {
  return at_infinity ? orientation_along(q, r, p, light) : orientation(p, q, r, light);
}

/// Whether the start lies in the cone from the light through the triangle, rim included, and the light is on
/// the side `side` of the triangle's plane.
bool isInCone(const float4& light, bool at_infinity, const std::array<float4, 3>& corners,
              const glm::vec3& at, int side) {
  if (sideOf(light, at_infinity, corners[0], corners[1], corners[2]) != side) return false;
  const float4 start{at.x, at.y, at.z, 0};
  for (int i = 0; i < 3; ++i)
    if (sideOf(light, at_infinity, start, corners[i], corners[(i + 1) % 3]) * side < 0) return false;
  return true;
}

/// Barycentric weights of the point where the ray to a light intersects the triangle. Each is the volume of
/// the tetrahedron of light, start and the other two corners, as in kernels/exact/blockers.clh, in a form
/// that doesn't cancel for a small triangle far from the light.
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
  // A weight of another sign than the sum is rounding.
  const double sum = weights.x + weights.y + weights.z;
  weights = glm::max(sum < 0 ? -weights : weights, glm::dvec3(0));
  const double total = weights.x + weights.y + weights.z;
  return total > 0 ? weights / total : glm::dvec3(1.0 / 3);
}

/// Determinants whose signs decide whether a triangle blocks a light, as linear functions of the direction s
/// to the light. Corners a, b, c are relative to the start, and σ is the side of the triangle's plane on
/// which the start lies. It blocks if
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
  const glm::dvec3 lengths = glm::max(glm::abs(lights.low), glm::abs(lights.high));
  const double most = std::max({sizes.x, sizes.y, sizes.z}),
               far = std::max({lengths.x, lengths.y, lengths.z});
  for (int i = 0; i < 3; ++i) volumes.edge[i] = -double(side) * glm::cross(from[i], from[(i + 1) % 3]);
  volumes.all = volumes.edge[0] + volumes.edge[1] + volumes.edge[2];
  volumes.start = lights.at_infinity ? 0 : -glm::dot(volumes.edge[0], from[2]);
  volumes.edge_error = 0x1p-47 * most * most * far;
  volumes.all_error = 0x1p-44 * most * most * (most + far);
  return volumes;
}

/// Bits of a block's triangles that may block any of the lights. heights: of the start over their planes. The
/// numbers are those of Volumes, with the extent of the directions' box added to their errors.
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

/// Clears the bits of the unblocked lights that a triangle blocks. height: of the start over its plane.
/// Returns whether it blocks any.
bool testTriangle(const TriangleTree& tree, std::size_t block, int slot, float height,
                  const HoleTest& is_hole, Lights& lights) {
  const float* const rows = &tree.blocks[block * kBlockRows * kLanes];
  const std::array<float4, 3> corners{cornerOf(rows, 0, slot), cornerOf(rows, 1, slot),
                                      cornerOf(rows, 2, slot)};
  const int side = height > 0 ? 1 : -1;
  if (orientation(corners[0], corners[1], corners[2], {lights.start.x, lights.start.y, lights.start.z, 0}) ==
      side)
    return false;
  const Volumes volumes = volumesOf(lights, corners, side);
  const bool has_holes = (tree.block_bits[block] >> (16 + slot) & 1) != 0;
  bool any = false;
  for (std::size_t row = 0; row < lights.rows; ++row) {
    if (lights.unblocked[row] == 0) continue;
    const Lanes3& directions = lights.directions[row];
    std::array<int, kLanes> may, certain;
    for (int i = 0; i < kLanes; ++i) {
      const auto along = [&](const glm::dvec3& m) {
        return m.x * directions[0][i] + m.y * directions[1][i] + m.z * directions[2][i];
      };
      const double edges = std::min({along(volumes.edge[0]), along(volumes.edge[1]), along(volumes.edge[2])});
      const double all = volumes.start + along(volumes.all);
      may[i] = (edges >= -volumes.edge_error) & (all >= -volumes.all_error);
      certain[i] = (edges > volumes.edge_error) & (all > volumes.all_error);
    }
    const std::uint32_t sure = bitsOf(certain) & lights.unblocked[row];
    std::uint32_t blocked = bitsOf(may) & lights.unblocked[row];
    for (std::uint32_t unsure = has_holes ? blocked : blocked & ~sure; unsure != 0; unsure &= unsure - 1) {
      const int bit = std::countr_zero(unsure);
      const float4& light = lights.place[row * kLanes + std::size_t(bit)];
      const bool hides =
          (sure >> bit & 1) != 0 || isInCone(light, lights.at_infinity, corners, lights.start, side);
      if (!hides || (has_holes && is_hole(tree.triangles[block * kLanes + std::size_t(slot)],
                                          weightsOf(lights, light, corners))))
        blocked &= ~(1u << bit);
    }
    lights.unblocked[row] &= ~blocked;
    any |= blocked != 0;
  }
  return any;
}

/// The same for all triangles of a block.
bool testBlock(const TriangleTree& tree, std::size_t number, const HoleTest& is_hole, Lights& lights) {
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
    any |= testTriangle(tree, number, slot, heights[slot], is_hole, lights);
  }
  return any;
}

std::size_t unblockedCount(const Lights& lights) {
  std::size_t count = 0;
  for (std::size_t row = 0; row < lights.rows; ++row)
    count += std::size_t(std::popcount(lights.unblocked[row]));
  return count;
}

}  // namespace

std::size_t countUnblocked(const TriangleTree& tree, const glm::vec3& start, std::span<const float4> places,
                           const HoleTest& is_hole, std::optional<std::size_t>& likely) {
  Lights lights;
  setLights(start, places, lights);
  const std::optional<std::size_t> first = likely;
  if (first && testBlock(tree, *first, is_hole, lights) && unblockedCount(lights) == 0) return 0;
  std::array<int, kMaxTreeDepth*(kLanes - 1) + 1> stack;
  int size = 0;
  stack[size++] = tree.root;
  while (size > 0) {
    const int reference = stack[--size];
    if (reference < 0) {
      const std::size_t number = ~unsigned(reference);
      if (first == number || !testBlock(tree, number, is_hole, lights)) continue;
      likely = number;
      if (unblockedCount(lights) == 0) return 0;
      continue;
    }
    const auto node = std::size_t(reference);
    for (std::uint32_t bits = childrenIn(lights, &tree.nodes[node * kNodeRows * kLanes]); bits != 0;
         bits &= bits - 1)
      stack[size++] = tree.children[node * kLanes + std::size_t(std::countr_zero(bits))];
  }
  return unblockedCount(lights);
}

bool isBlocked(const TriangleTree& tree, const glm::vec3& start, const BeamLight& light,
               const HoleTest& is_hole) {
  std::optional<std::size_t> likely;
  return countUnblocked(tree, start, {&light.place, 1}, is_hole, likely) == 0;
}

}  // namespace luciole
