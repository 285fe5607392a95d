#include "shadow/exact/triangle_tree.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <span>

#include "base/machine_memory.hpp"
#include "luciole/error.hpp"
#include "scene/count_triangles.hpp"
#include "shadow/exact/placed_triangles.hpp"
#include "shadow/exact/triangle_topology.hpp"

namespace luciole {
namespace {

constexpr std::uint64_t kMostTriangles = std::uint64_t(1) << 27;
constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// A bound of the magnitudes of coordinates relative to `origin`, of lights and of an object's corners.
double reachOf(const glm::dvec3& place) {
  return std::max({std::abs(place.x), std::abs(place.y), std::abs(place.z)});
}
double reachOf(const Object& object, float mesh_reach, const glm::dvec3& origin) {
  const glm::dmat4& m = object.object_to_world;
  const glm::dvec3 turned =
      glm::abs(glm::dvec3(m[0])) + glm::abs(glm::dvec3(m[1])) + glm::abs(glm::dvec3(m[2]));
  return reachOf(turned * double(mesh_reach) + glm::abs(glm::dvec3(m[3])) + glm::abs(origin));
}

/// TriangleTree::scale.
float scaleFor(const Scene& scene, const glm::dvec3& origin) {
  std::vector<float> mesh_reach(scene.meshes.size());
  tbb::parallel_for(std::size_t(0), scene.meshes.size(), [&](std::size_t i) {
    for (const glm::vec3& p : scene.meshes[i].positions)
      mesh_reach[i] = std::max({mesh_reach[i], std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  });
  double reach = 0;
  for (const Object& object : scene.objects)
    reach = std::max(reach, reachOf(object, mesh_reach[object.mesh], origin));
  for (const Light& light : scene.lights)
    if (light.kind != LightKind::kDirectional) reach = std::max(reach, reachOf(light.position - origin));
  if (reach <= kLargestPlaced) return 1;
  // The scale stays a normal float whatever the reach is: coordinates of scenes are below 2⁶⁰.
  return float(kLargestPlaced * std::exp2(-std::min(std::ceil(std::log2(reach)), 128.0)));
}

struct FloatBox {
  glm::vec3 low{kInfinity}, high{-kInfinity};
  void add(const glm::vec3& corner) {
    low = glm::min(low, corner);
    high = glm::max(high, corner);
  }
};

TriangleBoxes boxesOf(const PlacedTriangles& placed) {
  TriangleBoxes boxes(placed.first.back());
  tbb::parallel_for(std::size_t(0), placed.scene.objects.size(), [&](std::size_t object) {
    tbb::parallel_for(placed.first[object], placed.first[object + 1], [&, object](std::uint32_t i) {
      FloatBox box;
      for (const glm::dvec3& corner : cornersOf(placed, std::uint32_t(object), i)) box.add(corner);
      boxes[i].low = Quad{box.low.x, box.low.y, box.low.z, 0};
      boxes[i].minus_high = Quad{-box.high.x, -box.high.y, -box.high.z, 0};
      boxes[i].setNumber(i);
    });
  });
  return boxes;
}

/// Unit normal of the exact corners, with the orientation of the rounded ones, and offset. All 0 if either
/// are collinear, or their normals are perpendicular.
glm::vec4 planeOf(const std::array<glm::dvec3, 3>& exact, const std::array<glm::vec3, 3>& rounded) {
  const glm::dvec3 normal = glm::cross(exact[1] - exact[0], exact[2] - exact[0]);
  const glm::dvec3 a = rounded[0];
  const double side = glm::dot(normal, glm::cross(glm::dvec3(rounded[1]) - a, glm::dvec3(rounded[2]) - a));
  const double length = glm::length(normal);
  if (side == 0 || !(length > 0)) return glm::vec4(0);
  const glm::dvec3 unit = normal / (side > 0 ? length : -length);
  return glm::dvec4(unit, glm::dot(unit, exact[0]));
}

/// The objects of a block's triangles. Asks for all that cornersOf() and hasHoles() read: triangles of a
/// block lie anywhere in their meshes, and so they are waited for together.
std::array<std::uint32_t, kTreeWidth> fetchTriangles(const PlacedTriangles& placed,
                                                     std::span<const std::uint32_t> triangles) {
  std::array<std::uint32_t, kTreeWidth> objects;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    objects[i] = objectOf(placed, triangles[i]);
    const Mesh& mesh = placed.scene.meshes[placed.scene.objects[objects[i]].mesh];
    const std::uint32_t in_mesh = triangles[i] - placed.first[objects[i]];
    __builtin_prefetch(&mesh.triangles[in_mesh]);
    if (!mesh.triangle_materials.empty()) __builtin_prefetch(&mesh.triangle_materials[in_mesh]);
  }
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const Mesh& mesh = placed.scene.meshes[placed.scene.objects[objects[i]].mesh];
    const glm::uvec3& corners = mesh.triangles[triangles[i] - placed.first[objects[i]]];
    for (int corner = 0; corner < 3; ++corner) __builtin_prefetch(&mesh.positions[corners[corner]]);
  }
  return objects;
}

/// Writes a block's rows and bits of holes, and returns its box.
FloatBox fillBlock(const PlacedTriangles& placed, std::size_t block, TriangleTree& tree) {
  float* const rows = &tree.blocks[block * kBlockRows * kTreeWidth];
  const std::uint32_t used = tree.block_bits[block] & 0xffff;
  const std::array<std::uint32_t, kTreeWidth> objects =
      fetchTriangles(placed, {&tree.triangles[block * kTreeWidth], std::size_t(std::popcount(used))});
  std::uint32_t holes = 0;
  FloatBox box;
  for (int slot = 0; slot < kTreeWidth; ++slot) {
    const auto set = [&](int row, float value) { rows[row * kTreeWidth + slot] = value; };
    if ((used >> slot & 1) == 0) {
      for (int row = 0; row < kBlockRows; ++row) set(row, rows[row * kTreeWidth + slot - 1]);
      continue;
    }
    const std::uint32_t triangle = tree.triangles[block * kTreeWidth + slot], object = objects[slot];
    const std::array<glm::dvec3, 3> exact = cornersOf(placed, object, triangle);
    const std::array<glm::vec3, 3> rounded{exact[0], exact[1], exact[2]};
    const glm::vec4 plane = planeOf(exact, rounded);
    float farthest = 0;
    for (int corner = 0; corner < 3; ++corner) {
      box.add(rounded[corner]);
      const glm::vec3 size = glm::abs(rounded[corner]);
      farthest = std::max(farthest, size.x + size.y + size.z);
      for (int axis = 0; axis < 3; ++axis) set(kCornerRows + 3 * corner + axis, rounded[corner][axis]);
    }
    for (int i = 0; i < 4; ++i) set(kPlaneRows + i, plane[i]);
    set(kRoundingRow, CORNER_ROUNDING * farthest);
    holes |= std::uint32_t(hasHoles(placed, object, triangle)) << slot;
  }
  tree.block_bits[block] = used | holes << 16;
  return box;
}

/// Writes the box of a node's child, and adds it to the node's own.
void setChildBox(TriangleTree& tree, std::size_t node, int child, const FloatBox& box, FloatBox& own) {
  float* const rows = &tree.nodes[node * kNodeRows * kTreeWidth] + child;
  for (int axis = 0; axis < 3; ++axis) {
    rows[2 * axis * kTreeWidth] = box.low[axis];
    rows[(2 * axis + 1) * kTreeWidth] = box.high[axis];
  }
  own.low = glm::min(own.low, box.low);
  own.high = glm::max(own.high, box.high);
}

}  // namespace

TriangleTree buildTriangleTree(const Scene& scene, const glm::dvec3& origin) {
  const std::uint64_t count = countTriangles(scene);
  if (count > kMostTriangles)
    throw MachineError(fmt::format("{}: {} triangles, expected {} at most for shadows by beams", scene.name,
                                   count, kMostTriangles));
  TriangleTree tree;
  if (count == 0) {
    tree.children.assign(kTreeWidth, 0);
  } else {
    const double sorting = double(count) * 2 * sizeof(TriangleBox);
    const double kept = double(count) * (kBlockRows * sizeof(float) + sizeof(std::uint32_t)) * 1.5;
    requireMemory(std::max(sorting, kept), fmt::format("the tree over {} triangles", count));
    growTopology(boxesOf(placeTriangles(scene, origin, scaleFor(scene, origin))), tree);
  }
  tree.nodes.resize(tree.children.size() * kNodeRows);
  tree.blocks.resize(tree.triangles.size() * kBlockRows);
  refitTriangleTree(scene, origin, tree);
  return tree;
}

bool isPlacedFor(const Scene& scene, const glm::dvec3& origin, const TriangleTree& tree) {
  return tree.origin == origin && tree.scale == scaleFor(scene, origin);
}

double boxArea(const TriangleTree& tree) {
  double area = 0;
  for (std::size_t i = 0; i < tree.children.size(); ++i) {
    if (tree.children[i] == 0) continue;
    const float* rows = &tree.nodes[i / kTreeWidth * kNodeRows * kTreeWidth] + i % kTreeWidth;
    const auto side = [&](int axis) {
      return double(rows[(2 * axis + 1) * kTreeWidth]) - double(rows[2 * axis * kTreeWidth]);
    };
    area += side(0) * side(1) + side(1) * side(2) + side(2) * side(0);
  }
  return area;
}

void refitTriangleTree(const Scene& scene, const glm::dvec3& origin, TriangleTree& tree) {
  tree.origin = origin;
  tree.scale = scaleFor(scene, origin);
  const PlacedTriangles placed = placeTriangles(scene, origin, tree.scale);
  std::vector<FloatBox> block_boxes(tree.block_bits.size());
  tbb::parallel_for(std::size_t(0), block_boxes.size(),
                    [&](std::size_t i) { block_boxes[i] = fillBlock(placed, i, tree); });
  // By one thread: there are a hundred times as many triangles as nodes.
  std::vector<FloatBox> node_boxes(tree.children.size() / kTreeWidth);
  for (std::size_t node = node_boxes.size(); node-- > 0;) {
    for (int i = 0; i < kTreeWidth; ++i) {
      const int child = tree.children[node * kTreeWidth + i];
      const FloatBox box = child > 0 ? node_boxes[child] : child < 0 ? block_boxes[~child] : FloatBox{};
      setChildBox(tree, node, i, box, node_boxes[node]);
    }
  }
}

}  // namespace luciole
