#include "tools/bench/light_picks.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "scene/bounds.hpp"

namespace luciole {
namespace {

/// Fills in node `at`, and appends those below it.
void addNodes(std::span<const Light> lights, std::span<std::uint32_t> part, std::size_t at, PickTree& tree) {
  Bounds box;
  double power = 0;
  for (const std::uint32_t i : part) {
    const Light& light = lights[i];
    box.low = glm::min(box.low, light.position);
    box.high = glm::max(box.high, light.position);
    power += double(light.diffuse.x + light.diffuse.y + light.diffuse.z) / double(light.attenuation.z);
  }
  const glm::dvec3 size = box.high - box.low;
  const bool is_leaf = part.size() == 1;
  const auto child = std::int32_t(is_leaf ? ~part.front() : tree.nodes.size());
  tree.nodes[at] = {glm::vec3((box.low + box.high) / 2.0), float(glm::length(size) / 2), float(power), child};
  if (is_leaf) return;
  tree.nodes.resize(tree.nodes.size() + 2);
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const std::size_t half = part.size() / 2;
  std::nth_element(
      part.begin(), part.begin() + std::ptrdiff_t(half), part.end(),
      [&](std::uint32_t a, std::uint32_t b) { return lights[a].position[axis] < lights[b].position[axis]; });
  addNodes(lights, part.first(half), std::size_t(child), tree);
  addNodes(lights, part.subspan(half), std::size_t(child) + 1, tree);
}

/// What a node may give a surface, but for the surface's colour.
float importance(const PickTree::Node& node, const glm::vec3& point, const glm::vec3& normal) {
  const glm::vec3 way = node.middle - point;
  const float distance2 = glm::dot(way, way), radius2 = node.radius * node.radius;
  const float unshaded = node.power / std::max({distance2, radius2, 1e-20f});
  if (distance2 <= radius2) return unshaded;
  // The angle to the middle, less the one in which the box's sphere is seen.
  const float cosine = glm::dot(normal, way) / std::sqrt(distance2), part2 = radius2 / distance2;
  const float sphere_cosine = std::sqrt(1 - part2);
  if (cosine >= sphere_cosine) return unshaded;
  const float sine = std::sqrt(std::max(1 - cosine * cosine, 0.0f));
  return unshaded * std::max(cosine * sphere_cosine + sine * std::sqrt(part2), 0.0f);
}

}  // namespace

PickTree buildPickTree(std::span<const Light> lights) {
  PickTree tree{std::vector<PickTree::Node>(1)};
  std::vector<std::uint32_t> order(lights.size());
  std::iota(order.begin(), order.end(), 0u);
  addNodes(lights, order, 0, tree);
  return tree;
}

std::optional<LightPick> pickLight(const PickTree& tree, const glm::dvec3& point, const glm::dvec3& normal,
                                   double u) {
  const glm::vec3 from(point), facing(normal);
  std::int32_t at = 0;
  double probability = 1;
  for (;;) {
    const std::int32_t child = tree.nodes[std::size_t(at)].child;
    if (child < 0) return LightPick{std::uint32_t(~child), probability};
    const double first = importance(tree.nodes[std::size_t(child)], from, facing),
                 second = importance(tree.nodes[std::size_t(child) + 1], from, facing);
    if (!(first + second > 0)) return std::nullopt;
    const double share = first / (first + second);
    const bool is_first = u < share;
    // What is left of u is uniform again.
    u = is_first ? u / share : (u - share) / (1 - share);
    probability *= is_first ? share : 1 - share;
    at = child + (is_first ? 0 : 1);
  }
}

}  // namespace luciole
