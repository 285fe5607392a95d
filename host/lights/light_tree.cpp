#include "lights/light_tree.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "lights/sort_by_key.hpp"
#include "scene/z_curve.hpp"

namespace luciole {
namespace {

/// The Z curve has 2¹⁸ cells along an axis. Three times 18 bits and 10 for the range make a key of 64 bits.
constexpr int kCellBits = 18;

bool reachesEverywhere(const Light& light) {
  return light.kind == LightKind::kDirectional || !std::isfinite(light.range);
}

/// The upper 10 bits of a key: 0 for lights that reach everywhere, else 1 or more, growing with the range.
std::uint64_t rangeClass(const Light& light) {
  if (reachesEverywhere(light)) return 0;
  return std::uint64_t(std::clamp(std::ilogb(light.range), -510, 511) + 511);
}

/// The bounding box of lights with a position.
struct PositionBounds {
  glm::dvec3 low{std::numeric_limits<double>::infinity()};
  glm::dvec3 high{-std::numeric_limits<double>::infinity()};
};

PositionBounds positionBounds(std::span<const Light> lights) {
  const auto add = [&](const tbb::blocked_range<std::size_t>& range, PositionBounds places) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      if (reachesEverywhere(lights[i])) continue;
      places.low = glm::min(places.low, lights[i].position);
      places.high = glm::max(places.high, lights[i].position);
    }
    return places;
  };
  const auto join = [](const PositionBounds& a, const PositionBounds& b) {
    return PositionBounds{glm::min(a.low, b.low), glm::max(a.high, b.high)};
  };
  return tbb::parallel_reduce(tbb::blocked_range<std::size_t>(0, lights.size()), PositionBounds{}, add, join);
}

constexpr std::size_t rowsFor(std::size_t nodes) { return (nodes + kTreeArity - 1) / kTreeArity; }

/// A node's values, in the order of the planes.
using Node = std::array<float, 7>;
constexpr float kInfinity = std::numeric_limits<float>::infinity();
/// A node that reaches nothing: it is infinitely far from every finite box.
constexpr Node kPadding{kInfinity, kInfinity, kInfinity, kInfinity, kInfinity, kInfinity, 1};

/// The least and the greatest of sixteen, by halves, so that they become vector instructions.
float least(const float* values) {
  std::array<float, 8> halves;
  for (int i = 0; i < 8; ++i) halves[i] = std::min(values[i], values[i + 8]);
  for (int i = 0; i < 4; ++i) halves[i] = std::min(halves[i], halves[i + 4]);
  return std::min(std::min(halves[0], halves[2]), std::min(halves[1], halves[3]));
}
float greatest(const float* values) {
  std::array<float, 8> halves;
  for (int i = 0; i < 8; ++i) halves[i] = std::max(values[i], values[i + 8]);
  for (int i = 0; i < 4; ++i) halves[i] = std::max(halves[i], halves[i + 4]);
  return std::max(std::max(halves[0], halves[2]), std::max(halves[1], halves[3]));
}

/// Sets `node` to hold the row of sixteen children from `first` on, of which only `count` are nodes.
void setNodeOver(LightTree& tree, std::size_t node, std::size_t first, std::size_t count) {
  static_assert(kTreeArity == 16);
  for (std::size_t i = 0; i < kPadding.size(); ++i) {
    const float* row = &tree.planes[first + i * tree.stride];
    std::array<float, kTreeArity> filled;
    if (count < kTreeArity) {
      for (std::size_t child = 0; child < kTreeArity; ++child) filled[child] = row[child < count ? child : 0];
      row = filled.data();
    }
    const bool high = i >= 3 && i < 6;
    tree.planes[node + i * tree.stride] = high ? greatest(row) : least(row);
  }
}

void setNode(LightTree& tree, std::size_t place, const Node& node) {
  for (std::size_t i = 0; i < node.size(); ++i) tree.planes[place + i * tree.stride] = node[i];
}

}  // namespace

std::vector<std::uint32_t> spatialOrder(std::span<const Light> lights) {
  const PositionBounds places = positionBounds(lights);
  const glm::dvec3 cells =
      double((1 << kCellBits) - 1) / glm::max(places.high - places.low, glm::dvec3(1e-300));
  RawArray<Keyed> keyed(lights.size());
  tbb::parallel_for(std::size_t(0), lights.size(), [&](std::size_t i) {
    std::uint64_t key = rangeClass(lights[i]) << (3 * kCellBits);
    if (!reachesEverywhere(lights[i])) {
      const glm::dvec3 cell = (lights[i].position - places.low) * cells;
      key |= everyThirdBit(std::uint64_t(cell.x)) | everyThirdBit(std::uint64_t(cell.y)) << 1 |
             everyThirdBit(std::uint64_t(cell.z)) << 2;
    }
    keyed[i] = {key, std::uint32_t(i)};
  });
  sortByKey(keyed);
  std::vector<std::uint32_t> order(lights.size());
  tbb::parallel_for(std::size_t(0), order.size(), [&](std::size_t i) { order[i] = keyed[i].index; });
  return order;
}

LightTree buildLightTree(std::span<const ShadeLight> lights) {
  std::vector<std::size_t> level_nodes{lights.size()};
  while (rowsFor(level_nodes.back()) > 1) level_nodes.push_back(rowsFor(level_nodes.back()));
  LightTree tree;
  for (const std::size_t nodes : level_nodes) tree.stride += rowsFor(nodes) * kTreeArity;
  tree.planes.resize(kPadding.size() * tree.stride);

  std::size_t start = 0, children = 0;
  for (std::size_t level = 0; level < level_nodes.size(); ++level) {
    const std::size_t nodes = level_nodes[level], end = start + rowsFor(nodes) * kTreeArity;
    tbb::parallel_for(std::size_t(0), nodes, [&](std::size_t i) {
      if (level == 0) {
        // The same floats as in shading, so that both compute the same distances.
        const float4& p = lights[i].position;
        const bool directional = lights[i].kind == kDirectionalLight;
        setNode(tree, i, directional ? Node{} : Node{p.x, p.y, p.z, p.x, p.y, p.z, p.w});
      } else {
        const std::size_t first = i * kTreeArity;
        setNodeOver(tree, start + i, children + first, level_nodes[level - 1] - first);
      }
    });
    for (std::size_t i = start + nodes; i < end; ++i) setNode(tree, i, kPadding);
    children = start;
    start = end;
  }
  return tree;
}

}  // namespace luciole
