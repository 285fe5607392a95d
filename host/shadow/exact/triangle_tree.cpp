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

/// The objects of a block's triangles. Asks for all that cornersOf() and hasHoles() read: triangles of a
/// block lie anywhere in their meshes, and so they are waited for together.
std::array<std::uint32_t, kTreeWidth> fetchTriangles(const PlacedTriangles& placed,
                                                     std::span<const std::uint32_t> triangles) {
  std::array<std::uint32_t, kTreeWidth> objects;
  std::uint32_t object = objectOf(placed, triangles[0]);
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    // Mostly they are of one object.
    if (triangles[i] < placed.first[object] || triangles[i] >= placed.first[object + 1])
      object = objectOf(placed, triangles[i]);
    objects[i] = object;
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

template <class T>
using Slots = std::array<T, kTreeWidth>;

/// Writes the rows of planes: unit normal of the exact corners, with the orientation of the rounded ones, and
/// offset. All 0 if either are collinear, or their normals are perpendicular. `exact`: coordinate a of corner
/// c in row 3·c + a; `rows`: with the rounded corners.
void setPlanes(const std::array<Slots<double>, 9>& exact, float* rows) {
  const float* rounded = rows + int(kCornerRows) * kTreeWidth;
  float* out = rows + int(kPlaneRows) * kTreeWidth;
  for (int i = 0; i < kTreeWidth; ++i) {
    const auto corner = [&](int c) {
      return glm::dvec3(exact[3 * c][i], exact[3 * c + 1][i], exact[3 * c + 2][i]);
    };
    const auto cut = [&](int c) {
      const float* first = rounded + 3 * c * kTreeWidth + i;
      return glm::dvec3(first[0], first[kTreeWidth], first[2 * kTreeWidth]);
    };
    const glm::dvec3 normal = glm::cross(corner(1) - corner(0), corner(2) - corner(0));
    const double side = glm::dot(normal, glm::cross(cut(1) - cut(0), cut(2) - cut(0)));
    const double length = std::sqrt(glm::dot(normal, normal));
    const bool flat = (side == 0) | !(length > 0);
    const double divisor = side > 0 ? length : -length;
    const glm::dvec3 unit = normal / divisor;
    const double offset = glm::dot(unit, corner(0));
    out[i] = flat ? 0.0f : float(unit.x);
    out[kTreeWidth + i] = flat ? 0.0f : float(unit.y);
    out[2 * kTreeWidth + i] = flat ? 0.0f : float(unit.z);
    out[3 * kTreeWidth + i] = flat ? 0.0f : float(offset);
  }
}

/// Writes a block's rows and bits of holes, and returns its box.
FloatBox fillBlock(const PlacedTriangles& placed, std::size_t block, TriangleTree& tree) {
  float* const rows = &tree.blocks[block * kBlockRows * kTreeWidth];
  const std::uint32_t used = tree.block_bits[block] & 0xffff;
  const int count = std::popcount(used);
  const std::uint32_t* const triangles = &tree.triangles[block * kTreeWidth];
  const Slots<std::uint32_t> objects = fetchTriangles(placed, {triangles, std::size_t(count)});
  std::array<Slots<double>, 9> exact;
  std::uint32_t holes = 0;
  for (int slot = 0; slot < kTreeWidth; ++slot) {
    const int from = std::min(slot, count - 1);
    const std::array<glm::dvec3, 3> corners = cornersOf(placed, objects[from], triangles[from]);
    for (int row = 0; row < 9; ++row) exact[row][slot] = corners[row / 3][row % 3];
    if (slot < count) holes |= std::uint32_t(hasHoles(placed, objects[slot], triangles[slot])) << slot;
  }
  Slots<float> farthest{};
  FloatBox box;
  for (int corner = 0; corner < 3; ++corner) {
    float* const rounded = rows + (kCornerRows + 3 * corner) * kTreeWidth;
    for (int axis = 0; axis < 3; ++axis)
      for (int i = 0; i < kTreeWidth; ++i)
        rounded[axis * kTreeWidth + i] = float(exact[3 * corner + axis][i]);
    for (int i = 0; i < kTreeWidth; ++i) {
      const float size =
          std::abs(rounded[i]) + std::abs(rounded[kTreeWidth + i]) + std::abs(rounded[2 * kTreeWidth + i]);
      farthest[i] = farthest[i] < size ? size : farthest[i];
    }
  }
  for (int axis = 0; axis < 3; ++axis) {
    const float* const first = rows + (kCornerRows + axis) * kTreeWidth;
    Slots<float> low, high;
    for (int i = 0; i < kTreeWidth; ++i) {
      const float a = first[i], b = first[3 * kTreeWidth + i], c = first[6 * kTreeWidth + i];
      const float ab_low = b < a ? b : a, ab_high = a < b ? b : a;
      low[i] = c < ab_low ? c : ab_low;
      high[i] = ab_high < c ? c : ab_high;
    }
    box.low[axis] = *std::ranges::min_element(low);
    box.high[axis] = *std::ranges::max_element(high);
  }
  setPlanes(exact, rows);
  for (int i = 0; i < kTreeWidth; ++i)
    rows[int(kRoundingRow) * kTreeWidth + i] = CORNER_ROUNDING * farthest[i];
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
