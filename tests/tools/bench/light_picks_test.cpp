#include "tools/bench/light_picks.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "base/random.hpp"

namespace luciole::test {
namespace {

std::vector<Light> lightsBetween(double low, double high, std::size_t count) {
  std::vector<Light> lights(count);
  std::uint64_t state = 1;
  for (Light& light : lights) {
    for (int axis = 0; axis < 3; ++axis) light.position[axis] = between(low, high, nextUniform(state));
    light.diffuse = glm::vec3(float(0.1 + nextUniform(state)));
    light.attenuation = {0, 0, 1};
  }
  return lights;
}

TEST(LightPicks, AreAsFrequentAsTheirProbabilityOnEverySideOfTheLights) {
  const std::vector<Light> lights = lightsBetween(-1, 1, 50);
  const PickTree tree = buildPickTree(lights);
  EXPECT_EQ(tree.nodes.size(), 2 * lights.size() - 1);
  const int parts = 100'000;
  for (const glm::dvec3& point : {glm::dvec3(0), glm::dvec3(0, 0, -3), glm::dvec3(0.5, -1.5, 0.9)}) {
    std::map<std::uint32_t, std::pair<double, double>> of;  // probability, share
    for (int i = 0; i < parts; ++i)
      if (const auto pick = pickLight(tree, point, {0, 0, 1}, (i + 0.5) / parts)) {
        of[pick->light].first = pick->probability;
        of[pick->light].second += 1.0 / parts;
      }
    for (std::uint32_t i = 0; i < lights.size(); ++i) {
      const bool faces = lights[i].position.z > point.z;
      EXPECT_TRUE(of.contains(i) || !faces) << "a light that shines there is picked";
      // Each light has an interval of u.
      EXPECT_NEAR(of[i].first, of[i].second, 2.0 / parts);
    }
  }
}

TEST(LightPicks, WhatLightsASurfaceMoreIsPickedMoreAndWhatIsBehindItNever) {
  std::vector<Light> lights = lightsBetween(0, 0, 2);
  lights[0].position = {0, 0, 1};
  lights[1].position = {0, 0, 2};
  lights[0].diffuse = lights[1].diffuse = glm::vec3(1);
  const auto pick = pickLight(buildPickTree(lights), {0, 0, 0}, {0, 0, 1}, 0.5);
  ASSERT_TRUE(pick);
  EXPECT_EQ(pick->light, 0u);
  EXPECT_NEAR(pick->probability, 0.8, 1e-6) << "at half the distance";
  lights[0].position.z = -1;
  for (const double u : {0.0, 0.5, 0.999})
    EXPECT_EQ(pickLight(buildPickTree(lights), {0, 0, 0}, {0, 0, 1}, u)->light, 1u);
  EXPECT_FALSE(pickLight(buildPickTree(lights), {0, 0, 3}, {0, 0, 1}, 0.5));
}

}  // namespace
}  // namespace luciole::test
