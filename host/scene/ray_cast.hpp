#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "scene/scene.hpp"

namespace luciole {

/// A scene's triangles in a tree of boxes, to ask what a ray meets. For choosing a camera, where a ray that
/// slips between two triangles does no harm: float precision, relative to `origin`.
struct RayTree {
  struct Triangle {
    glm::vec3 corner, side_a, side_b;  ///< counter-clockwise seen from its front
  };
  /// Triangles [first, first + count) where count > 0; else the children are the next node and node `first`.
  struct Node {
    glm::vec3 low, high;
    std::uint32_t first, count;
  };
  glm::dvec3 origin{0.0};  ///< world position of the tree's zero
  std::vector<Triangle> triangles;
  std::vector<Node> nodes;  ///< nodes[0] is the root; empty for no triangles
};

RayTree buildRayTree(const Scene& scene, const glm::dvec3& origin);

struct RayHit {
  double distance;         ///< metres
  bool front;              ///< the triangle's front was met
  std::uint32_t triangle;  ///< index in RayTree::triangles
};
/// The nearest triangle that the ray meets; `direction` is unit, both are in world space.
std::optional<RayHit> castRay(const RayTree& tree, const glm::dvec3& from, const glm::dvec3& direction);

}  // namespace luciole
