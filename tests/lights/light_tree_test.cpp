#include "lights/light_tree.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "kernels/random_scene.hpp"
#include "lights/shade_lights.hpp"

namespace luciole::test {
namespace {

std::vector<Light> randomLights(int count, Random& random) {
  return randomScene(randomCamera(random), count, random).lights;
}

class SpatialOrder : public testing::TestWithParam<int> {};

TEST_P(SpatialOrder, HoldsEachLightOnceAndIsTheSameEveryTime) {
  Random random(3);
  const std::vector<Light> lights = randomLights(GetParam(), random);
  std::vector<std::uint32_t> order = spatialOrder(lights);
  EXPECT_EQ(spatialOrder(lights), order);
  std::sort(order.begin(), order.end());
  std::vector<std::uint32_t> all(lights.size());
  std::iota(all.begin(), all.end(), 0u);
  EXPECT_EQ(order, all);
}

INSTANTIATE_TEST_SUITE_P(Lights, SpatialOrder, testing::Values(0, 1, 17, 5000),
                         testing::PrintToStringParamName());

TEST(SpatialOrder, LightsOfEqualPlaceAndRangeKeepTheirOrder) {
  for (const float range : {2.0f, std::numeric_limits<float>::infinity()}) {
    std::vector<Light> lights(100);
    for (Light& light : lights) {
      light.position = {1, 2, 3};
      light.range = range;
    }
    std::vector<std::uint32_t> as_they_are(lights.size());
    std::iota(as_they_are.begin(), as_they_are.end(), 0u);
    EXPECT_EQ(spatialOrder(lights), as_they_are) << range;
  }
}

TEST(SpatialOrder, LightsThatReachEverywhereComeFirst) {
  Random random(3);
  const std::vector<Light> lights = randomLights(500, random);
  bool limited = false;
  for (const std::uint32_t i : spatialOrder(lights)) {
    const bool everywhere = lights[i].kind == LightKind::kDirectional || std::isinf(lights[i].range);
    EXPECT_FALSE(everywhere && limited);
    limited |= !everywhere;
  }
  EXPECT_TRUE(limited);
}

TEST(SpatialOrder, NeighboursInItAreNeighboursInSpace) {
  // A cube of 16³ lights a metre apart: sixteen in a row make a box of 4 × 2 × 2 or so, not a line through
  // all.
  std::vector<Light> lights;
  for (int i = 0; i < 4096; ++i) {
    Light light;
    light.position = {i % 16, i / 16 % 16, i / 256};
    light.range = 1;
    lights.push_back(light);
  }
  const std::vector<std::uint32_t> order = spatialOrder(lights);
  double sides = 0;
  for (std::size_t first = 0; first < order.size(); first += 16) {
    glm::dvec3 low(100), high(-100);
    for (std::size_t i = first; i < first + 16; ++i) {
      low = glm::min(low, lights[order[i]].position);
      high = glm::max(high, lights[order[i]].position);
    }
    const glm::dvec3 side = high - low;
    sides += side.x + side.y + side.z;
  }
  // 4 × 2 × 2 lights are 5 m in all; cells that don't fall between lights everywhere make some boxes larger.
  EXPECT_LT(sides / (order.size() / 16), 8);
}

// Two pictures from different cameras add the same lights in the same order.
TEST(SpatialOrder, CamerasSeeTheSameOrder) {
  Random random(7);
  const Camera camera = randomCamera(random), other = randomCamera(random);
  Scene scene = randomScene(camera, 200, random);
  for (std::size_t i = 0; i < scene.lights.size(); ++i) scene.lights[i].diffuse.x = float(i);
  const RawArray<ShadeLight> a = prepareLights(scene, camera, {}), b = prepareLights(scene, other, {});
  const std::vector<std::uint32_t> order = spatialOrder(scene.lights);
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].diffuse.x, float(order[i]));
    EXPECT_EQ(b[i].diffuse.x, float(order[i]));
  }
}

/// Places of the levels in a tree's planes, as kernels/lights/cull.cl has them: nodes, rounded up to whole
/// rows.
struct Level {
  std::size_t start, nodes, room;
};

std::vector<Level> levelsOf(std::size_t lights) {
  std::vector<Level> levels;
  std::size_t start = 0, nodes = lights;
  for (;;) {
    const std::size_t rows = (nodes + kTreeArity - 1) / kTreeArity;
    levels.push_back({start, nodes, rows * kTreeArity});
    if (rows <= 1) return levels;
    start += rows * kTreeArity;
    nodes = rows;
  }
}

class Tree : public testing::TestWithParam<int> {};

TEST_P(Tree, EveryNodeHoldsItsChildrenAndPaddingReachesNothing) {
  Random random(11);
  const Camera camera = randomCamera(random);
  const RawArray<ShadeLight> lights = prepareLights(randomScene(camera, GetParam(), random), camera, {});
  const LightTree tree = buildLightTree(lights);
  const std::vector<Level> levels = levelsOf(lights.size());
  ASSERT_EQ(tree.stride, levels.back().start + levels.back().room);
  ASSERT_EQ(tree.planes.size(), 7 * tree.stride);
  const auto value = [&](std::size_t node, int plane) { return tree.planes[node + plane * tree.stride]; };
  for (std::size_t i = 0; i < lights.size(); ++i) {
    const float4& at = lights[i].position;
    EXPECT_EQ(value(i, 6), lights[i].position.w);
    if (lights[i].kind == kDirectionalLight) continue;  // anywhere, as it reaches everywhere
    for (const int corner : {0, 3}) {
      EXPECT_EQ(value(i, corner), at.x);
      EXPECT_EQ(value(i, corner + 1), at.y);
      EXPECT_EQ(value(i, corner + 2), at.z);
    }
  }
  for (std::size_t level = 0; level < levels.size(); ++level) {
    const Level& here = levels[level];
    for (std::size_t i = 0; level > 0 && i < levels[level - 1].nodes; ++i) {
      const std::size_t child = levels[level - 1].start + i, node = here.start + i / kTreeArity;
      for (int c = 0; c < 3; ++c) {
        ASSERT_LE(value(node, c), value(child, c));
        ASSERT_GE(value(node, c + 3), value(child, c + 3));
      }
      ASSERT_LE(value(node, 6), value(child, 6));
    }
    for (std::size_t i = here.nodes; i < here.room; ++i) {
      // Farther from any finite place than any range is.
      EXPECT_TRUE(std::isinf(value(here.start + i, 0)));
      EXPECT_GT(value(here.start + i, 6), 0);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Lights, Tree, testing::Values(0, 1, 16, 17, 256, 257, 4097),
                         testing::PrintToStringParamName());

}  // namespace
}  // namespace luciole::test
