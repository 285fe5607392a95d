#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "luciole/scene.hpp"

namespace luciole {

/// A binary tree over point lights that fade with the square of the distance, by which lights are picked at
/// random: A. Estevez Conty and C. Kulla, "Importance Sampling of Many Lights with Adaptive Tree Splitting"
/// (2018), without the splitting. A rival that is measured; pictures don't use it.
struct PickTree {
  struct Node {
    glm::vec3 middle;    ///< of the box around the lights, world, metres
    float radius;        ///< half the box's diagonal
    float power;         ///< of all its lights
    std::int32_t child;  ///< the first of two that follow each other; below 0: ~ the index of its only light
  };
  std::vector<Node> nodes;  ///< the root first
};

/// Each node's lights are halved along their box's longest side. `lights` must not be empty. O(n log n).
PickTree buildPickTree(std::span<const Light> lights);

struct LightPick {
  std::uint32_t light;
  double probability;
};
/// Goes down from the root, to a child as often as it may light a surface there more than the other: by its
/// power, its distance and the least angle between the normal (unit) and a place in its box. u: uniform in
/// [0,1). Empty if that came to two children that can't light it.
std::optional<LightPick> pickLight(const PickTree& tree, const glm::dvec3& point, const glm::dvec3& normal,
                                   double u);

}  // namespace luciole
