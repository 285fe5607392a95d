#include "scene/gltf/gltf_nodes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>

#include "scene/posing.hpp"

namespace luciole {
namespace {

/// A node's own transform: given as a matrix, or as its three parts.
struct LocalTransform {
  bool is_matrix = false;
  glm::dmat4 matrix{1.0};
  glm::dvec3 translate{0.0}, scale{1.0};
  glm::dvec4 rotation{0.0, 0.0, 0.0, 1.0};
};

LocalTransform localTransform(const GltfModel& model, int index) {
  const GltfNode& node = model.file.nodes[std::size_t(index)];
  const auto has = [&](const std::vector<double>& values, std::size_t count, const char* name) {
    if (values.empty() || values.size() == count) return !values.empty();
    failGltf(model, nodePlace(index),
             fmt::format("{} has {} numbers, expected {}", name, values.size(), count));
  };
  LocalTransform local;
  if (has(node.matrix, 16, "matrix")) {
    local.is_matrix = true;
    for (int i = 0; i < 16; ++i) local.matrix[i / 4][i % 4] = node.matrix[std::size_t(i)];
    const glm::dvec4 last_row(local.matrix[0].w, local.matrix[1].w, local.matrix[2].w, local.matrix[3].w);
    if (last_row != glm::dvec4(0, 0, 0, 1)) {
      warnRepaired(model, nodePlace(index),
                   fmt::format("matrix has {} {} {} {} as last row, taken for 0 0 0 1", last_row.x,
                               last_row.y, last_row.z, last_row.w),
                   "last row");
      for (int i = 0; i < 4; ++i) local.matrix[i].w = i == 3 ? 1 : 0;
    }
    if (!node.translation.empty() || !node.rotation.empty() || !node.scale.empty())
      warnRepaired(model, nodePlace(index), "has a matrix, and parts beside it, which are left out",
                   "matrix and parts");
    return local;
  }
  for (int i = 0; has(node.translation, 3, "translation") && i < 3; ++i)
    local.translate[i] = node.translation[std::size_t(i)];
  for (int i = 0; has(node.rotation, 4, "rotation") && i < 4; ++i)
    local.rotation[i] = node.rotation[std::size_t(i)];
  for (int i = 0; has(node.scale, 3, "scale") && i < 3; ++i) local.scale[i] = node.scale[std::size_t(i)];
  if (const double length = glm::length(local.rotation); !isUnitLength(length)) {
    warnRepaired(model, nodePlace(index),
                 fmt::format("rotation is of length {}, expected a unit quaternion", length), "rotation");
    if (!(length > 0)) local.rotation = {0, 0, 0, 1};
  }
  local.matrix = placementByQuaternion(local.translate, local.rotation, local.scale);
  return local;
}

/// Takes a matrix apart into the parts that animations move. Of one that shears, what they can't hold is
/// lost.
void takeApart(LocalTransform& local) {
  glm::dmat3 axes(local.matrix);
  for (int i = 0; i < 3; ++i) local.scale[i] = glm::length(axes[i]);
  if (glm::determinant(axes) < 0) local.scale.x = -local.scale.x;
  local.translate = glm::dvec3(local.matrix[3]);
  // An axis of length 0 is across the others, and two or three that are so may be any.
  for (int i = 0; i < 3; ++i)
    if (local.scale[i] != 0) axes[i] /= local.scale[i];
  for (int i = 0; i < 3; ++i)
    if (local.scale[i] == 0) axes[i] = glm::cross(axes[(i + 1) % 3], axes[(i + 2) % 3]);
  const glm::dquat turn = glm::quat_cast(axes);
  const glm::dvec4 rotation(turn.x, turn.y, turn.z, turn.w);
  if (const double length = glm::length(rotation); length > 0 && std::isfinite(length))
    local.rotation = rotation / length;
}

/// The MovingNode of an animated node. Parts that no curve moves keep the node's own value.
MovingNode movingNode(const LocalTransform& local, const NodeCurves& curves, Animation& animation) {
  const auto orConstant = [&](int curve, const glm::dvec4& value) {
    if (curve >= 0) return curve;
    animation.curves.push_back(constantCurve(value));
    return static_cast<int>(animation.curves.size()) - 1;
  };
  MovingNode moving;
  moving.quaternion = true;
  moving.translate = orConstant(curves.translation, glm::dvec4(local.translate, 0));
  moving.rotate = orConstant(curves.rotation, local.rotation);
  moving.scale = orConstant(curves.scale, glm::dvec4(local.scale, 0));
  return moving;
}

/// The nodes at the top of the scene to show: the default one, else the first, else every node without a
/// parent.
std::vector<int> rootNodes(const GltfModel& model) {
  const GltfFile& file = model.file;
  if (!file.scenes.empty()) return element(model, file.scenes, std::max(file.scene, 0), "scene", "scene");
  std::vector<bool> is_child(file.nodes.size(), false);
  for (const GltfNode& node : file.nodes) {
    for (const int child : node.children) {
      if (child >= 0 && static_cast<std::size_t>(child) < is_child.size()) is_child[child] = true;
    }
  }
  std::vector<int> roots;
  for (std::size_t i = 0; i < is_child.size(); ++i) {
    if (!is_child[i]) roots.push_back(static_cast<int>(i));
  }
  return roots;
}

/// Of each node the one that it is a child of; -1: none. Throws InputError unless every node has one parent
/// at most. A root may have one outside the scene, which counts for nothing.
std::vector<int> parentsOf(const GltfModel& model, const std::vector<int>& roots) {
  const std::vector<GltfNode>& nodes = model.file.nodes;
  std::vector<int> parents(nodes.size(), -1), in_scene;
  std::vector<bool> is_used(nodes.size(), false), is_root(nodes.size(), false),
      is_in_scene(nodes.size(), false);
  const auto use = [&](int node, const std::string& place) {
    element(model, nodes, node, place, "node");
    if (is_used[node])
      failGltf(model, nodePlace(node), "has two parents or contains itself, expected a tree");
    is_used[node] = true;
  };
  const auto useChild = [&](int node, int parent) {
    use(node, nodePlace(parent));
    parents[node] = parent;
  };
  for (const int root : roots) {
    use(root, "scene");
    is_root[root] = true;
    in_scene.push_back(root);
  }
  for (std::size_t i = 0; i < in_scene.size(); ++i) {
    const int parent = in_scene[i];
    is_in_scene[parent] = true;
    for (const int child : nodes[parent].children) {
      useChild(child, parent);
      in_scene.push_back(child);
    }
  }
  for (int parent = 0; parent < static_cast<int>(nodes.size()); ++parent) {
    if (is_in_scene[parent]) continue;
    for (const int child : nodes[parent].children) {
      if (child < 0 || std::size_t(child) >= nodes.size() || !is_root[child])
        useChild(child, parent);
      else
        warnRepaired(
            model, nodePlace(child),
            fmt::format("is the scene's and nodes[{}]'s, which is not in the scene; drawn without that",
                        parent),
            "parent");
    }
  }
  return parents;
}

/// The node above all others that a node lies below. Throws InputError where it lies below itself.
int topOf(const GltfModel& model, const std::vector<int>& parents, int node) {
  int top = node;
  for (std::size_t steps = 0; parents[top] >= 0; ++steps) {
    if (steps > parents.size()) failGltf(model, nodePlace(node), "contains itself, expected a tree");
    top = parents[top];
  }
  return top;
}

/// Appends a tree of nodes, parents first. `shown`: as PlacedNode has it. with_hidden: also those that are
/// hidden.
void placeTree(const GltfModel& model, int root, bool shown, bool with_hidden,
               const std::map<int, NodeCurves>& curves, Animation& animation,
               std::vector<PlacedNode>& placed) {
  const std::vector<GltfNode>& nodes = model.file.nodes;
  std::vector<PlacedNode> stack{{.node = root, .shown = shown}};
  while (!stack.empty()) {
    PlacedNode next = stack.back();
    stack.pop_back();
    if (nodes[next.node].hidden) next.shown = false;
    if (!next.shown && !with_hidden) continue;
    LocalTransform local = localTransform(model, next.node);
    next.to_world = next.to_world * local.matrix;
    if (!isFinite(next.to_world)) failGltf(model, nodePlace(next.node), "transform is not finite");
    const auto animated = curves.find(next.node);
    if (animated != curves.end() && movesNode(animated->second)) {
      if (local.is_matrix) {
        warnRepaired(model, nodePlace(next.node),
                     "has a matrix and is animated; it is taken apart into translation, rotation and scale",
                     "animated matrix");
        takeApart(local);
      }
      MovingNode moving = movingNode(local, animated->second, animation);
      moving.parent = next.moving;
      moving.before = next.since;
      next.moving = static_cast<int>(animation.nodes.size());
      next.since = glm::dmat4(1.0);
      animation.nodes.push_back(moving);
    } else {
      next.since = next.since * local.matrix;
    }
    placed.push_back(next);
    const std::vector<int>& children = nodes[next.node].children;
    for (auto child = children.rbegin(); child != children.rend(); ++child) {
      stack.push_back(next);
      stack.back().node = *child;
    }
  }
}

}  // namespace

std::string nodePlace(int node) { return fmt::format("nodes[{}]", node); }

std::vector<PlacedNode> placedNodes(const GltfModel& model, const std::map<int, NodeCurves>& curves,
                                    Animation& animation) {
  const std::vector<GltfNode>& nodes = model.file.nodes;
  const std::vector<int> roots = rootNodes(model), parents = parentsOf(model, roots);
  const bool has_skins = std::ranges::any_of(nodes, [](const auto& node) { return node.skin >= 0; });
  std::vector<PlacedNode> placed;
  for (const int root : roots) placeTree(model, root, true, has_skins, curves, animation, placed);
  if (!has_skins) return placed;
  std::vector<bool> is_placed(nodes.size(), false);
  for (const PlacedNode& node : placed) is_placed[node.node] = true;
  for (std::size_t i = 0; i < model.file.skins.size(); ++i)
    for (const int joint : model.file.skins[i].joints) {
      element(model, nodes, joint, fmt::format("skins[{}]", i), "node");
      if (is_placed[joint]) continue;
      const std::size_t first = placed.size();
      placeTree(model, topOf(model, parents, joint), false, true, curves, animation, placed);
      for (std::size_t n = first; n < placed.size(); ++n) is_placed[placed[n].node] = true;
    }
  return placed;
}

}  // namespace luciole
