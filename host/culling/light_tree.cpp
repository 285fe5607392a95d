#include "culling/light_tree.hpp"

#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>
#include <limits>

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

constexpr std::size_t rowsFor(std::size_t nodes) { return (nodes + kTreeArity - 1) / kTreeArity; }

/// A node's values, in the order of the planes.
using Node = std::array<float, 7>;
constexpr float kInfinity = std::numeric_limits<float>::infinity();
/// A node that reaches nothing: it is infinitely far from every finite box.
constexpr Node kPadding{kInfinity, kInfinity, kInfinity, kInfinity, kInfinity, kInfinity, 1};

Node nodeOver(const LightTree& tree, std::size_t first, std::size_t count) {
  Node node{kInfinity, kInfinity, kInfinity, -kInfinity, -kInfinity, -kInfinity, kInfinity};
  for (std::size_t child = first; child < first + count; ++child)
    for (std::size_t i = 0; i < node.size(); ++i) {
      const float value = tree.planes[child + i * tree.stride];
      const bool high = i >= 3 && i < 6;
      node[i] = high ? std::max(node[i], value) : std::min(node[i], value);
    }
  return node;
}

void setNode(LightTree& tree, std::size_t place, const Node& node) {
  for (std::size_t i = 0; i < node.size(); ++i) tree.planes[place + i * tree.stride] = node[i];
}

}  // namespace

std::vector<std::uint32_t> spatialOrder(std::span<const Light> lights) {
  glm::dvec3 low(std::numeric_limits<double>::infinity()), high(-low);
  for (const Light& light : lights) {
    if (reachesEverywhere(light)) continue;
    low = glm::min(low, light.position);
    high = glm::max(high, light.position);
  }
  const glm::dvec3 cells = double((1 << kCellBits) - 1) / glm::max(high - low, glm::dvec3(1e-300));
  struct Keyed {
    std::uint64_t key;
    std::uint32_t light;
    bool operator<(const Keyed& other) const {
      return std::tie(key, light) < std::tie(other.key, other.light);
    }
  };
  std::vector<Keyed> keyed(lights.size());
  tbb::parallel_for(std::size_t(0), lights.size(), [&](std::size_t i) {
    keyed[i] = {rangeClass(lights[i]) << (3 * kCellBits), std::uint32_t(i)};
    if (reachesEverywhere(lights[i])) return;
    const glm::dvec3 cell = (lights[i].position - low) * cells;
    keyed[i].key |= everyThirdBit(std::uint64_t(cell.x)) | everyThirdBit(std::uint64_t(cell.y)) << 1 |
                    everyThirdBit(std::uint64_t(cell.z)) << 2;
  });
  tbb::parallel_sort(keyed);
  std::vector<std::uint32_t> order(lights.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = keyed[i].light;
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
        setNode(tree, start + i,
                nodeOver(tree, children + first,
                         std::min<std::size_t>(kTreeArity, level_nodes[level - 1] - first)));
      }
    });
    for (std::size_t i = start + nodes; i < end; ++i) setNode(tree, i, kPadding);
    children = start;
    start = end;
  }
  return tree;
}

}  // namespace luciole
