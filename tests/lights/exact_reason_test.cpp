// Which lights others may stand for, and why not the rest.
#include "lights/exact_reason.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace luciole::test {
namespace {

Light everywhere() { return {.attenuation = {0, 0, 2}}; }

TEST(ExactReason, IsNoneForAPointLightThatFallsOffByTheSquare) {
  for (const Model model : {Model::kPhong, Model::kBlinnPhong})
    EXPECT_EQ(exactReason(everywhere(), {model, true}), ExactReason::kNone);
}

TEST(ExactReason, IsToldForEachLightThatNothingStandsFor) {
  const auto reasonOf = [](auto change, bool shadows = true) {
    Light light = everywhere();
    change(light);
    return exactReason(light, {Model::kPhong, shadows});
  };
  EXPECT_EQ(exactReason(everywhere(), {Model::kToon, true}), ExactReason::kModel);
  EXPECT_EQ(exactReason(everywhere(), {Model::kCookTorrance, true}), ExactReason::kModel);
  EXPECT_EQ(reasonOf([](Light& light) { light.kind = LightKind::kDirectional; }), ExactReason::kKind);
  EXPECT_EQ(reasonOf([](Light& light) { light.kind = LightKind::kSpot; }), ExactReason::kKind);
  EXPECT_EQ(reasonOf([](Light& light) { light.range = 1e30f; }), ExactReason::kRange);
  EXPECT_EQ(reasonOf([](Light& light) { light.attenuation = {1e-30f, 0, 1}; }), ExactReason::kAttenuation);
  EXPECT_EQ(reasonOf([](Light& light) { light.attenuation = {0, 1, 1}; }), ExactReason::kAttenuation);
  EXPECT_EQ(reasonOf([](Light& light) { light.attenuation = {1, 0, 0}; }), ExactReason::kAttenuation);
  EXPECT_EQ(reasonOf([](Light& light) { light.ambient.z = 1e-30f; }), ExactReason::kAmbient);
  EXPECT_EQ(reasonOf([](Light& light) { light.shadow = true; }), ExactReason::kShadow);
  EXPECT_EQ(reasonOf([](Light& light) { light.shadow = true; }, false), ExactReason::kNone);
}

TEST(ExactReason, EveryLightIsCountedOnce) {
  std::vector<Light> lights(10000, everywhere());
  for (std::size_t i = 0; i < lights.size(); i += 4) lights[i].kind = LightKind::kSpot;
  for (std::size_t i = 1; i < lights.size(); i += 4) lights[i].range = 3;
  const auto counts = countReasons(lights, {Model::kPhong, true});
  EXPECT_EQ(counts[std::size_t(ExactReason::kNone)], 5000u);
  EXPECT_EQ(counts[std::size_t(ExactReason::kKind)], 2500u);
  EXPECT_EQ(counts[std::size_t(ExactReason::kRange)], 2500u);
}

}  // namespace
}  // namespace luciole::test
