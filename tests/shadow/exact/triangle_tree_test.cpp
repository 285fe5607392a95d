#include "shadow/exact/triangle_tree.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <tuple>

#include "luciole/error.hpp"
#include "shadow/exact/loose_triangles.hpp"
#include "shadow/maps/shadow_scenes.hpp"

namespace luciole::test {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

struct Box {
  glm::vec3 low{kInfinity}, high{-kInfinity};
  bool operator==(const Box&) const = default;
};

Box boxOf(const TriangleTree& tree, std::size_t node, int child) {
  const float* rows = &tree.nodes[node * kNodeRows * kTreeWidth] + child;
  return {{rows[0], rows[2 * kTreeWidth], rows[4 * kTreeWidth]},
          {rows[kTreeWidth], rows[3 * kTreeWidth], rows[5 * kTreeWidth]}};
}

/// A row of a block's triangle.
float at(const TriangleTree& tree, std::size_t block, int row, int slot) {
  return tree.blocks[(block * kBlockRows + row) * kTreeWidth + slot];
}

glm::vec3 cornerAt(const TriangleTree& tree, std::size_t block, int corner, int slot) {
  return {at(tree, block, kCornerRows + 3 * corner, slot),
          at(tree, block, kCornerRows + 3 * corner + 1, slot),
          at(tree, block, kCornerRows + 3 * corner + 2, slot)};
}

/// The corners of all triangles of a scene as the tree must have them, and in double.
struct Expected {
  std::vector<std::array<glm::vec3, 3>> rounded;
  std::vector<std::array<glm::dvec3, 3>> exact;
};
Expected expectedCorners(const Scene& scene, const TriangleTree& tree) {
  Expected expected;
  for (const Object& object : scene.objects) {
    const Mesh& mesh = scene.meshes[object.mesh];
    for (const glm::uvec3& triangle : mesh.triangles) {
      std::array<glm::dvec3, 3> exact;
      for (int i = 0; i < 3; ++i)
        exact[i] =
            (glm::dvec3(object.object_to_world * glm::dvec4(mesh.positions[triangle[i]], 1)) - tree.origin) *
            double(tree.scale);
      expected.exact.push_back(exact);
      expected.rounded.push_back({exact[0], exact[1], exact[2]});
    }
  }
  return expected;
}

/// Normal and offset are right to some roundings of floats where the triangle isn't too thin for doubles.
void expectPlane(const std::array<glm::dvec3, 3>& exact, const std::array<glm::vec3, 3>& rounded,
                 const glm::vec4& plane) {
  for (int i = 0; i < 4; ++i) ASSERT_TRUE(std::isfinite(plane[i]));
  if (plane == glm::vec4(0)) return;
  ASSERT_NEAR(glm::length(glm::dvec3(plane)), 1, 0x1p-22);
  const glm::dvec3 a = rounded[0],
                   turned = glm::cross(glm::dvec3(rounded[1]) - a, glm::dvec3(rounded[2]) - a);
  ASSERT_GT(glm::dot(glm::dvec3(plane), turned), 0) << "the orientation of the rounded corners";
  for (const glm::dvec3& corner : exact) {
    // Each of four numbers is rounded by 2⁻²⁴ of itself, and the corners of thin triangles move a double's
    // cross product.
    const double reach = glm::dot(glm::abs(corner), glm::dvec3(1)) + std::abs(double(plane.w));
    ASSERT_NEAR(glm::dot(glm::dvec3(plane), corner), plane.w, 0x1p-23 * reach + 0x1p-149);
  }
}

/// Holds a tree against its promises. Returns its depth.
int expectTreeOver(const Scene& scene, const TriangleTree& tree) {
  const Expected expected = expectedCorners(scene, tree);
  std::vector<int> seen(expected.rounded.size());
  int depth = 0;
  std::size_t blocks = 0, nodes = 0;
  const std::function<Box(int, int)> visit = [&](int reference, int above) -> Box {
    Box all;
    const auto add = [&](const Box& box) {
      all = {glm::min(all.low, box.low), glm::max(all.high, box.high)};
    };
    if (reference < 0) {
      const std::size_t block = ~reference;
      EXPECT_EQ(block, blocks++);
      const std::uint32_t used = tree.block_bits[block] & 0xffff;
      EXPECT_TRUE(used != 0 && (used & (used + 1)) == 0) << "slots are used from the first on";
      for (int slot = 0; slot < kTreeWidth; ++slot) {
        const std::uint32_t triangle = tree.triangles[block * kTreeWidth + slot];
        if (triangle >= seen.size()) {
          ADD_FAILURE() << "triangle " << triangle;
          return all;
        }
        if (used >> slot & 1)
          ++seen[triangle];
        else
          EXPECT_EQ(triangle, tree.triangles[block * kTreeWidth + slot - 1]);
        for (int i = 0; i < 3; ++i) {
          const glm::vec3 corner = cornerAt(tree, block, i, slot);
          EXPECT_EQ(corner, expected.rounded[triangle][i]);
          EXPECT_TRUE(glm::all(glm::lessThanEqual(glm::abs(corner), glm::vec3(0x1p40f))));
          add({corner, corner});
        }
        expectPlane(expected.exact[triangle], expected.rounded[triangle],
                    {at(tree, block, kPlaneRows, slot), at(tree, block, kPlaneRows + 1, slot),
                     at(tree, block, kPlaneRows + 2, slot), at(tree, block, kPlaneRows + 3, slot)});
      }
      return all;
    }
    EXPECT_EQ(reference, int(nodes++)) << "nodes lie in the order of a walk";
    depth = std::max(depth, above + 1);
    for (int i = 0; i < kTreeWidth; ++i) {
      const int child = tree.children[std::size_t(reference) * kTreeWidth + i];
      const Box box = boxOf(tree, std::size_t(reference), i);
      const Box below = child == 0 ? Box{} : visit(child, above + 1);
      EXPECT_EQ(box, below);
      add(below);
    }
    return all;
  };
  visit(tree.root, 0);
  EXPECT_TRUE(std::all_of(seen.begin(), seen.end(), [](int times) { return times == 1; }));
  EXPECT_EQ(tree.block_bits.size(), blocks);
  EXPECT_EQ(tree.children.size(), nodes * kTreeWidth);
  EXPECT_EQ(tree.nodes.size(), nodes * kTreeWidth * kNodeRows);
  EXPECT_LE(depth, kMaxTreeDepth);
  return depth;
}

template <class T>
bool sameArrays(const RawArray<T>& a, const RawArray<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

void expectSame(const TriangleTree& a, const TriangleTree& b) {
  EXPECT_EQ(std::tie(a.origin, a.scale, a.root), std::tie(b.origin, b.scale, b.root));
  EXPECT_TRUE(sameArrays(a.nodes, b.nodes));
  EXPECT_TRUE(sameArrays(a.children, b.children));
  EXPECT_TRUE(sameArrays(a.blocks, b.blocks));
  EXPECT_TRUE(sameArrays(a.triangles, b.triangles));
  EXPECT_TRUE(sameArrays(a.block_bits, b.block_bits));
}

TEST(TriangleTree, HoldsEveryTriangleOnceInBoxesThatFit) {
  const glm::dvec3 origin(0.3, -0.2, 5);
  for (const int count : {17, 300, 70000}) {
    const Scene scene = looseScene(randomTriangles(count, 0.02f, 1));
    expectTreeOver(scene, buildTriangleTree(scene, origin));
  }
  const Scene terrain = terrainScene();
  expectTreeOver(terrain, buildTriangleTree(terrain, origin));
}

TEST(TriangleTree, BlocksAreMostlyFull) {
  const Scene scene = looseScene(randomTriangles(20000, 0.02f, 2));
  const TriangleTree tree = buildTriangleTree(scene, glm::dvec3(0));
  EXPECT_LT(tree.block_bits.size(), 20000 / 12);
  EXPECT_LT(tree.children.size() / kTreeWidth, tree.block_bits.size() / 4);
}

TEST(TriangleTree, EqualTrianglesFillTheirBlocks) {
  const Scene scene =
      looseScene(std::vector<Triangle>(5003, {glm::vec3(1, 2, 3), glm::vec3(2), glm::vec3(1)}));
  const TriangleTree tree = buildTriangleTree(scene, glm::dvec3(0));
  EXPECT_EQ(tree.block_bits.size(), (5003 + 15) / 16);
  EXPECT_EQ(expectTreeOver(scene, tree), 3) << "313 blocks by 16, rounded up";
}

TEST(TriangleTree, OneBlockIsTheRootAndAnEmptySceneHasAnEmptyNode) {
  const Scene few = looseScene(randomTriangles(16, 1, 3));
  const TriangleTree block = buildTriangleTree(few, glm::dvec3(0));
  EXPECT_EQ(block.root, ~0);
  EXPECT_EQ(expectTreeOver(few, block), 0);
  const TriangleTree empty = buildTriangleTree(Scene{}, glm::dvec3(0));
  EXPECT_EQ(empty.root, 0);
  EXPECT_EQ(expectTreeOver(Scene{}, empty), 1);
}

TEST(TriangleTree, DoesNotDependOnThreads) {
  const Scene scene = looseScene(randomTriangles(100000, 0.02f, 4));
  const TriangleTree all = buildTriangleTree(scene, glm::dvec3(1));
  for (const std::size_t threads : {1, 2, 3}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    expectSame(buildTriangleTree(scene, glm::dvec3(1)), all);
  }
}

TEST(TriangleTree, RefitsToAnotherPoseAndOrigin) {
  Scene scene = terrainScene();
  TriangleTree tree = buildTriangleTree(scene, glm::dvec3(0));
  const TriangleTree first = buildTriangleTree(scene, glm::dvec3(0));
  scene.objects.back().object_to_world[3] = {0.25, 3, -1, 1};
  scene.objects.front().object_to_world[0] *= -0.5;
  refitTriangleTree(scene, {1, 2, 3}, tree);
  expectTreeOver(scene, tree);
  EXPECT_TRUE(sameArrays(tree.triangles, first.triangles));
  scene.objects = terrainScene().objects;
  refitTriangleTree(scene, glm::dvec3(0), tree);
  expectSame(tree, first);
}

TEST(TriangleTree, MaterialsWithHolesAreMarked) {
  Scene scene = looseScene(randomTriangles(100, 0.1f, 5));
  for (int i = 0; i < 100; i += 3) scene.meshes[0].triangle_materials[i] = 1;
  scene.objects.push_back(scene.objects[0]);
  scene.objects[1].material = 1;
  const TriangleTree tree = buildTriangleTree(scene, glm::dvec3(0));
  for (std::size_t i = 0; i < tree.triangles.size(); ++i) {
    const std::uint32_t bits = tree.block_bits[i / kTreeWidth] >> i % kTreeWidth,
                        triangle = tree.triangles[i];
    if ((bits & 1) == 0) continue;
    EXPECT_EQ(bits >> 16 & 1, triangle >= 100 || triangle % 3 == 0);
  }
}

/// Each triangle is a millionth closer to a corner than the one before, so that splits by area cut few off at
/// a time.
std::vector<Triangle> shrinking(int count) {
  std::vector<Triangle> triangles;
  for (int i = 0; i < count; ++i) {
    const float scale = std::exp2(-float(i % 240) - 0.001f * float(i));
    triangles.push_back({glm::vec3(scale, 0, 0), glm::vec3(0, scale, 0), glm::vec3(scale, scale, scale)});
  }
  return triangles;
}

/// Of all sizes around one point.
std::vector<Triangle> nested(int count) {
  std::vector<Triangle> triangles;
  for (int i = 1; i <= count; ++i) {
    const float scale = float(i);
    triangles.push_back({glm::vec3(-scale, -scale, 0), glm::vec3(scale, -scale, 0), glm::vec3(0, scale, 0)});
  }
  return triangles;
}

TEST(TriangleTree, IsNeverDeeperThanItsLimit) {
  const std::vector<Triangle> equal(5000, {glm::vec3(1, 2, 3), glm::vec3(2, 2, 3), glm::vec3(1, 3, 3)});
  const std::vector<Triangle> point(5000, {glm::vec3(1), glm::vec3(1), glm::vec3(1)});
  for (const std::vector<Triangle>& triangles : {shrinking(30000), nested(5000), equal, point}) {
    const Scene scene = looseScene(triangles);
    expectTreeOver(scene, buildTriangleTree(scene, glm::dvec3(0)));
  }
}

TEST(TriangleTree, CoordinatesOf1e18AreScaledBelow2To40) {
  std::vector<Triangle> triangles = randomTriangles(500, 1, 6);
  for (std::size_t i = 0; i < triangles.size(); i += 2)
    for (glm::vec3& corner : triangles[i]) corner *= 1e18f;
  const Scene scene = looseScene(triangles);
  const TriangleTree tree = buildTriangleTree(scene, {-1e18, 1, 2});
  EXPECT_LT(tree.scale, 1);
  int exponent = 0;
  EXPECT_EQ(std::frexp(tree.scale, &exponent), 0.5f);
  expectTreeOver(scene, tree);
}

TEST(TriangleTree, ALightFarAwayScalesToo) {
  Scene scene = looseScene(randomTriangles(50, 1, 7));
  EXPECT_EQ(buildTriangleTree(scene, glm::dvec3(0)).scale, 1);
  scene.lights = {{.position = {0, 1e15, 0}}};
  const TriangleTree tree = buildTriangleTree(scene, glm::dvec3(0));
  EXPECT_LE(1e15 * tree.scale, 0x1p40);
  EXPECT_GT(1e15 * tree.scale, 0x1p37);
}

TEST(TriangleTree, PlanesAreRightFarFromTheOriginAndZeroWithoutArea) {
  // Corners 1000 km away are rounded by centimetres. Their plane passes through the world's origin, and is
  // right there.
  const Scene large = looseScene({{glm::vec3(-1e6f), glm::vec3(1e6f, 1e6f, -1e6f), glm::vec3(0, 0, 1e6f)}});
  const glm::dvec3 origin(0.123456, 1.234567, 2.345678);
  const TriangleTree tree = buildTriangleTree(large, origin);
  const glm::dvec3 normal(at(tree, 0, kPlaneRows, 0), at(tree, 0, kPlaneRows + 1, 0),
                          at(tree, 0, kPlaneRows + 2, 0));
  EXPECT_NEAR(glm::dot(normal, -origin), at(tree, 0, kPlaneRows + 3, 0), 1e-6);

  const glm::vec3 a(1, 2, 3), b(4, 5, 6);
  const Scene thin = looseScene({{a, a, a}, {a, b, a}, {a, b, 2.0f * b - a}});
  const TriangleTree none = buildTriangleTree(thin, glm::dvec3(0));
  for (int slot = 0; slot < kTreeWidth; ++slot)
    for (int row = kPlaneRows; row < kRoundingRow; ++row) EXPECT_EQ(at(none, 0, row, slot), 0);
}

TEST(TriangleTree, PlanesTurnAsTheRoundedCornersDo) {
  // Corners are rounded by up to half of a triangle.
  Scene scene = looseScene(randomTriangles(500, 1e-5f, 9));
  scene.objects[0].object_to_world[3] = {50, 60, 70, 1};
  expectTreeOver(scene, buildTriangleTree(scene, glm::dvec3(0)));
}

TEST(TriangleTree, CornersThatAreNoNumbersLeaveNoNumbersThatAreNone) {
  std::vector<Triangle> triangles = randomTriangles(100, 1, 8);
  triangles[7][1].y = std::numeric_limits<float>::quiet_NaN();
  triangles[50][2].x = kInfinity;
  Scene scene = looseScene(triangles);
  scene.objects.push_back(scene.objects[0]);
  scene.objects[1].object_to_world[0] *= 1e100;
  const TriangleTree tree = buildTriangleTree(scene, glm::dvec3(0));
  for (const float value : tree.blocks) ASSERT_TRUE(std::isfinite(value));
}

TEST(TriangleTree, RefusesMoreTrianglesThanItCanCount) {
  Scene scene = looseScene(std::vector<Triangle>(1 << 18));
  scene.objects.resize((1 << 9) + 1);
  try {
    buildTriangleTree(scene, glm::dvec3(0));
    FAIL() << "no error";
  } catch (const MachineError& error) {
    EXPECT_STREQ(error.what(), "loose: 134479872 triangles, expected 134217728 at most for shadows by beams");
  }
}

}  // namespace
}  // namespace luciole::test
