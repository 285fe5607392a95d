#include "tools/bench/shadow_errors.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "render_json.hpp"
#include "tools/bench/shadow_scenes.hpp"

// Shadow maps held against rays, in scenes that are hard for them.
namespace luciole::test {
namespace {

constexpr glm::ivec2 kSize(320, 180);

ShadowErrors errorsOf(const Scene& scene, ShadowMethod method) {
  ShadeSettings settings;
  settings.shadows = method;
  const ShadowErrors errors = shadowErrors(testDevice(), scene, kSize, settings);
  fmt::print("{}: {} lit, wrong {}; {} dark, wrong {}; {} at edges, wrong {}\n", scene.name, errors.lit,
             errors.wrongly_dark, errors.dark, errors.wrongly_lit, errors.edges, errors.wrong_edges);
  return errors;
}

class HardShadows : public testing::TestWithParam<int> {
 protected:
  Scene scene = makeShadowScenes()[GetParam()];
};

TEST_P(HardShadows, AwayFromEdgesMapsAreRightForAllButOneInTwoHundred) {
  for (const ShadowMethod method : {ShadowMethod::kHard, ShadowMethod::kPcf}) {
    const ShadowErrors errors = errorsOf(scene, method);
    EXPECT_GT(errors.lit, 1000);
    EXPECT_GT(errors.dark, 50);
    EXPECT_LE((errors.wrongly_dark + errors.wrongly_lit) * 200, errors.lit + errors.dark);
  }
}

TEST_P(HardShadows, ExactOnesAreWhatRaysSayEverywhere) {
  const ShadowErrors errors = errorsOf(scene, ShadowMethod::kExact);
  EXPECT_EQ(errors.wrongly_dark, 0u);
  EXPECT_EQ(errors.wrongly_lit, 0u);
  EXPECT_EQ(errors.wrong_edges, 0u);
}

// Maps of different sizes: each is looked up with a reach of its own.
TEST(ShadowErrors, DontDependOnTheLightsOrder) {
  Scene scene = makeShadowScenes()[2];  // the fence
  scene.lights[0].half_angle = glm::radians(5.0);
  Light lamp;
  lamp.position = {0, 2, -1};
  lamp.radius = 1;
  lamp.range = 6;
  lamp.shadow = true;
  scene.lights.push_back(lamp);
  const ShadowErrors errors = errorsOf(scene, ShadowMethod::kSoft);
  std::swap(scene.lights[0], scene.lights[1]);
  EXPECT_EQ(errorsOf(scene, ShadowMethod::kSoft), errors);
  EXPECT_GT(errors.dark, 100);
}

INSTANTIATE_TEST_SUITE_P(Scenes, HardShadows, testing::Range(0, 5), [](const auto& test) {
  std::string name = makeShadowScenes()[test.param].name;
  name.erase(std::remove(name.begin(), name.end(), ' '), name.end());
  return name;
});

TEST(AnimatedSun, NothingAwayFromEdgesFlickersInSixtySteps) {
  // Every step of every pixel away from a true edge shows what is true, so it changes only when the truth
  // does.
  Scene scene = makeShadowScenes()[2];  // the fence
  std::uint64_t dark = 0;
  for (int step = 0; step < 60; ++step) {
    const double angle = 0.01 * step;
    scene.lights[0].direction =
        glm::normalize(glm::dvec3(0.6 * std::cos(angle), -0.5, -0.35 - 0.6 * std::sin(angle)));
    ShadeSettings settings;
    settings.shadows = ShadowMethod::kPcf;
    const ShadowErrors errors = shadowErrors(testDevice(), scene, {160, 90}, settings);
    EXPECT_EQ(errors.wrongly_dark + errors.wrongly_lit, 0u) << "step " << step;
    dark += errors.dark;
  }
  EXPECT_GT(dark, 60u * 100);
}

}  // namespace
}  // namespace luciole::test
