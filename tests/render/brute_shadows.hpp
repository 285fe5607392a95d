#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <glm/glm.hpp>

#include "gbuffer/gbuffer.hpp"
#include "kernels/exact_sign.h"
#include "kernels/shared.h"
#include "render/beam_shadows.hpp"
#include "shadow/triangle_tree.hpp"

// The shadow of every triangle on a point, one by one: what beams are judged by.
namespace luciole::test {

/// Whether a triangle of the tree hides the start point from the light. Without holes.
inline bool hides(const TriangleTree& tree, std::size_t block, int slot, const glm::vec3& start,
                  const BeamLight& light) {
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
  if (orientation(corner[0], corner[1], corner[2], s) == side) return false;
  for (int v = 0; v < 3; ++v) {
    const float4 &x = corner[v], &y = corner[(v + 1) % 3];
    if ((parallel ? orientation_along(x, y, s, light.place) : orientation(x, y, s, light.place)) == -side)
      return false;
  }
  return true;
}

/// Whether any triangle does.
inline bool isHidden(const TriangleTree& tree, const glm::vec3& start, const BeamLight& light) {
  for (std::size_t block = 0; block < tree.block_bits.size(); ++block)
    for (int slot = 0; slot < kTreeWidth; ++slot)
      if ((tree.block_bits[block] >> slot & 1) != 0 && hides(tree, block, slot, start, light)) return true;
  return false;
}

/// A pixel's start point in the tree's space, by the operations of kernels/beam_points.clh.
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
