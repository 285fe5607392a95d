#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <glm/glm.hpp>

#include "kernels/exact/exact_sign.h"
#include "kernels/shared.h"
#include "lighting/lighting.hpp"
#include "luciole/gbuffer.hpp"
#include "shadow/exact/exact_ray.hpp"
#include "shadow/exact/light_samples.hpp"
#include "shadow/exact/triangle_tree.hpp"

// The shadow of every triangle on a point, one by one: what beams are judged by.
namespace luciole::test {

/// Whether a triangle of the tree hides the start point from the light. Without holes.
/// anywhere: though the point is before the triangle's corners, too (blockers.clh).
inline bool hides(const TriangleTree& tree, std::size_t block, int slot, const glm::vec3& start,
                  const BeamLight& light, bool anywhere = false) {
  const float* rows = tree.blocks.data() + block * (std::size_t(kBlockRows) * kTreeWidth);
  std::array<float4, 3> corner;
  for (int v = 0; v < 3; ++v)
    corner[v] = {rows[(3 * v) * kTreeWidth + slot], rows[(3 * v + 1) * kTreeWidth + slot],
                 rows[(3 * v + 2) * kTreeWidth + slot], 0};
  const bool parallel = light.place.w == 0;
  const int side = parallel ? orientation_along(corner[1], corner[2], corner[0], light.place)
                            : orientation(corner[0], corner[1], corner[2], light.place);
  if (side == 0) return false;
  const auto plane = [&](int i) { return rows[(int(kPlaneRows) + i) * kTreeWidth + slot]; };
  const float height =
      std::fma(plane(0), start.x, std::fma(plane(1), start.y, std::fma(plane(2), start.z, -plane(3))));
  const float tolerance = POINT_ERROR * ((std::abs(start.x) + std::abs(start.y)) + std::abs(start.z));
  const float own = rows[int(kRoundingRow) * kTreeWidth + slot];
  if (!(float(side) * height > std::max(tolerance, own))) return false;
  const float4 s{start.x, start.y, start.z, 0};
  if (!anywhere && orientation(corner[0], corner[1], corner[2], s) == side) return false;
  for (int v = 0; v < 3; ++v) {
    const float4 &x = corner[v], &y = corner[(v + 1) % 3];
    if ((parallel ? orientation_along(x, y, s, light.place) : orientation(x, y, s, light.place)) == -side)
      return false;
  }
  return true;
}

/// The weights of a triangle's corners where the line through start and light meets its plane, by Cramer's
/// rule.
inline glm::dvec3 weightsAt(const TriangleTree& tree, std::size_t block, int slot, const glm::vec3& start,
                            const BeamLight& light) {
  const float* rows = tree.blocks.data() + block * (std::size_t(kBlockRows) * kTreeWidth);
  std::array<glm::dvec3, 3> corner;
  for (int v = 0; v < 3; ++v)
    for (int axis = 0; axis < 3; ++axis) corner[v][axis] = rows[(3 * v + axis) * kTreeWidth + slot];
  const glm::dvec3 from(start), place(light.place.x, light.place.y, light.place.z);
  const glm::dvec3 way = light.place.w == 0 ? place : place - from;
  const glm::dmat3 columns(corner[0] - from, corner[1] - from, corner[2] - from);
  const glm::dvec3 weights = glm::inverse(columns) * way;
  return weights / (weights.x + weights.y + weights.z);
}

/// Whether the start point lies before a triangle that would hide it anywhere.
inline bool isBeforeOne(const TriangleTree& tree, const glm::vec3& start, const BeamLight& light) {
  for (std::size_t block = 0; block < tree.block_bits.size(); ++block)
    for (int slot = 0; slot < kTreeWidth; ++slot)
      if ((tree.block_bits[block] >> slot & 1) != 0 && !hides(tree, block, slot, start, light) &&
          hides(tree, block, slot, start, light, true))
        return true;
  return false;
}

/// Whether any triangle does. is_hole: of a triangle with holes; without it there are none.
inline bool isHidden(const TriangleTree& tree, const glm::vec3& start, const BeamLight& light,
                     const HoleTest& is_hole = {}) {
  for (std::size_t block = 0; block < tree.block_bits.size(); ++block)
    for (int slot = 0; slot < kTreeWidth; ++slot) {
      const uint bits = tree.block_bits[block];
      if ((bits >> slot & 1) == 0 || !hides(tree, block, slot, start, light)) continue;
      if (!is_hole || (bits >> (kTreeWidth + slot) & 1) == 0 ||
          !is_hole(tree.triangles[block * kTreeWidth + std::size_t(slot)],
                   weightsAt(tree, block, slot, start, light)))
        return true;
    }
  return false;
}

/// The share of a light that reaches the start point: of its samples, if it has a size. light: its index on
/// the device.
inline float shareSeen(const Lighting& lighting, const glm::vec3& start, std::uint32_t light,
                       const HoleTest& is_hole = {}) {
  const BeamScene& beams = lighting.beams;
  const BeamLight& beam = lighting.lights.beam_lights[light];
  if (beam.size == 0) return isHidden(*beams.tree, start, beam, is_hole) ? 0 : 1;
  std::vector<float4> places(std::size_t(beams.soft_samples));
  if (!placeSamples(beam, start,
                    patternOf(beams.samples, beams.soft_samples, start, lighting.lights.order[light]),
                    places))
    return 1;
  int seen = 0;
  for (const float4& place : places)
    seen += !isHidden(*beams.tree, start, BeamLight{place, 0, 0, 0, 0}, is_hole);
  return float(seen) / float(places.size());
}

/// PairShadows on the host.
struct PairWords {
  std::vector<uint> lit, unsure, first_share;
  std::vector<float> shares;
};
inline PairWords downloadPairs(OpenedDevice& device, const PairShadows& pairs) {
  PairWords words{std::vector<uint>(pairs.lit.count), std::vector<uint>(pairs.unsure.count),
                  std::vector<uint>(pairs.first_share.count), std::vector<float>(pairs.shares.count)};
  download(device, pairs.lit, words.lit);
  download(device, pairs.unsure, words.unsure);
  download(device, pairs.first_share, words.first_share);
  download(device, pairs.shares, words.shares);
  return words;
}

/// What exact shadows say of a pair: the share of the light that reaches the pixel. entry: of the lists;
/// pixel: in its tile.
inline float shareOf(const PairWords& pairs, std::size_t entry, std::size_t pixel) {
  const std::size_t word = entry * kPairWords + pixel / 32;
  const uint bit = 1u << pixel % 32;
  if (pairs.shares.empty() || (pairs.unsure[word] & bit) == 0) return (pairs.lit[word] & bit) != 0 ? 1 : 0;
  return pairs.shares[pairs.first_share[word] + uint(std::popcount(pairs.unsure[word] & (bit - 1)))];
}

/// A pixel's start point in the tree's space, by the operations of kernels/exact/beam_points.clh.
inline glm::vec3 startInTree(const BeamScene& beams, const GBuffer& gbuffer, std::size_t place) {
  const std::size_t stride = gbuffer.pixels();
  std::array<float, 3> p;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    p[axis] = gbuffer.position[place + axis * stride];
    if (!gbuffer.lift.empty())
      p[axis] = std::fma(gbuffer.lift[place], gbuffer.normal[place + axis * stride], p[axis]);
  }
  glm::vec3 start;
  for (int axis = 0; axis < 3; ++axis) {
    const auto row = [&](int column) { return beams.view_to_tree[column][axis]; };
    start[axis] = std::fma(p[2], row(2), std::fma(p[0], row(0), p[1] * row(1))) * beams.tree->scale;
  }
  return start;
}

}  // namespace luciole::test
