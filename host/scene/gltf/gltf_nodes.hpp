#pragma once

#include <glm/glm.hpp>
#include <map>
#include <string>
#include <vector>

#include "luciole/animation.hpp"
#include "scene/gltf/gltf_animation.hpp"
#include "scene/gltf/gltf_model.hpp"

namespace luciole {

/// A node with its world transform.
struct PlacedNode {
  int node = 0;
  glm::dmat4 to_world{1.0};  ///< without animation
  int moving = -1;           ///< the node of Animation::nodes that it is attached to; -1: none
  glm::dmat4 since{1.0};     ///< from the node's space to that of `moving`, or to world space if −1
  bool shown = true;         ///< false: only skins may need it
};

/// Whether a quaternion of this length is as good as unit: those of 8 bits are as long as 1 ± 1 / 127.
inline bool isUnitLength(double length) { return length > 0.99 && length < 1.01; }

/// "nodes[index]", for messages.
std::string nodePlace(int node);

/// Every node of the scene that isn't hidden (KHR_node_visibility), parents first; where the file has skins
/// also those that are, and the trees of joints outside the scene. Nodes that curves move are added to the
/// animation. Throws InputError unless the nodes form trees (roots without a parent, other nodes with at most
/// one), and where a transform isn't finite. What nodes have beside a matrix, last rows of matrices and
/// rotations that aren't unit are repaired, each with a warning.
std::vector<PlacedNode> placedNodes(const GltfModel& model, const std::map<int, NodeCurves>& curves,
                                    Animation& animation);

}  // namespace luciole
