#include "scene/ray_cast.hpp"

#include <algorithm>
#include <limits>
#include <span>

namespace luciole {
namespace {

constexpr std::size_t kLeafSize = 4;

glm::vec3 middleOf(const RayTree::Triangle& t) { return t.corner + (t.side_a + t.side_b) / 3.0f; }

/// Appends the node over triangles [first, last) and all below it: halves by the median along the longest
/// side.
void appendNode(RayTree& tree, std::size_t first, std::size_t last) {
  const std::span triangles = std::span(tree.triangles).subspan(first, last - first);
  constexpr float kHuge = std::numeric_limits<float>::max();
  glm::vec3 low{kHuge}, high{-kHuge}, middle_low{kHuge}, middle_high{-kHuge};
  for (const RayTree::Triangle& t : triangles) {
    for (const glm::vec3& p : {t.corner, t.corner + t.side_a, t.corner + t.side_b}) {
      low = glm::min(low, p);
      high = glm::max(high, p);
    }
    middle_low = glm::min(middle_low, middleOf(t));
    middle_high = glm::max(middle_high, middleOf(t));
  }
  const std::size_t node = tree.nodes.size();
  tree.nodes.push_back(
      {low, high, static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(last - first)});
  if (last - first <= kLeafSize) return;

  const glm::vec3 extent = middle_high - middle_low;
  int axis = extent.y > extent.x ? 1 : 0;
  if (extent.z > extent[axis]) axis = 2;
  const std::size_t half = triangles.size() / 2;
  std::nth_element(triangles.begin(), triangles.begin() + static_cast<std::ptrdiff_t>(half), triangles.end(),
                   [axis](const auto& a, const auto& b) { return middleOf(a)[axis] < middleOf(b)[axis]; });
  appendNode(tree, first, first + half);
  tree.nodes[node].first = static_cast<std::uint32_t>(tree.nodes.size());
  tree.nodes[node].count = 0;
  appendNode(tree, first + half, last);
}

bool meetsBox(const RayTree::Node& node, const glm::vec3& from, const glm::vec3& inverse_direction,
              float farthest) {
  const glm::vec3 a = (node.low - from) * inverse_direction;
  const glm::vec3 b = (node.high - from) * inverse_direction;
  float enter = 0;
  float leave = farthest;
  for (int i = 0; i < 3; ++i) {
    enter =
        std::max(enter, std::min(a[i], b[i]));  // a NaN, from 0 · ∞, is the second argument and is dropped
    leave = std::min(leave, std::max(a[i], b[i]));
  }
  return enter <= leave;
}

}  // namespace

RayTree buildRayTree(const Scene& scene, const glm::dvec3& origin) {
  RayTree tree;
  tree.origin = origin;
  for (const Object& object : scene.objects) {
    const Mesh& mesh = scene.meshes[object.mesh];
    const bool mirrored = glm::determinant(glm::dmat3(object.object_to_world)) < 0;
    const auto place = [&](std::uint32_t vertex) {
      return glm::dvec3(object.object_to_world * glm::dvec4(mesh.positions[vertex], 1)) - origin;
    };
    for (glm::uvec3 t : mesh.triangles) {
      if (mirrored) std::swap(t.y, t.z);
      const glm::dvec3 corner = place(t.x);
      tree.triangles.push_back({corner, place(t.y) - corner, place(t.z) - corner});
    }
  }
  if (!tree.triangles.empty()) appendNode(tree, 0, tree.triangles.size());
  return tree;
}

std::optional<RayHit> castRay(const RayTree& tree, const glm::dvec3& from, const glm::dvec3& direction) {
  if (tree.nodes.empty()) return std::nullopt;
  const glm::vec3 o = from - tree.origin;
  const glm::vec3 d = direction;
  float nearest = std::numeric_limits<float>::max();
  std::optional<RayHit> hit;
  std::vector<std::uint32_t> open{0};
  while (!open.empty()) {
    const std::uint32_t index = open.back();
    const RayTree::Node& node = tree.nodes[index];
    open.pop_back();
    if (!meetsBox(node, o, 1.0f / d, nearest)) continue;
    if (node.count == 0) {
      open.push_back(node.first);
      open.push_back(index + 1);
      continue;
    }
    // Möller and Trumbore 1997, "Fast, Minimum Storage Ray/Triangle Intersection".
    for (const RayTree::Triangle& t : std::span(tree.triangles).subspan(node.first, node.count)) {
      const glm::vec3 p = glm::cross(d, t.side_b);
      const float determinant = glm::dot(t.side_a, p);
      if (determinant == 0) continue;
      const glm::vec3 s = o - t.corner;
      const float u = glm::dot(s, p) / determinant;
      const glm::vec3 q = glm::cross(s, t.side_a);
      const float v = glm::dot(d, q) / determinant;
      const float distance = glm::dot(t.side_b, q) / determinant;
      if (u >= 0 && v >= 0 && u + v <= 1 && distance > 0 && distance < nearest) {
        nearest = distance;
        hit = RayHit{distance, determinant > 0, static_cast<std::uint32_t>(&t - tree.triangles.data())};
      }
    }
  }
  return hit;
}

}  // namespace luciole
