// Which lights others may stand for, and why not the rest.
#include "lights/light_use.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace luciole::test {
namespace {

Light everywhere() { return {.attenuation = {0, 0, 2}}; }

TEST(LightUse, APointLightThatFallsOffByTheSquareIsClustered) {
  for (const Model model : {Model::kPhong, Model::kBlinnPhong})
    EXPECT_EQ(lightUse(everywhere(), {model, ShadowMethod::kExact}), LightUse::kClustered);
}

TEST(LightUse, TellsWhyALightIsSummed) {
  const auto reasonOf = [](auto change, ShadowMethod shadows = ShadowMethod::kHard) {
    Light light = everywhere();
    change(light);
    return lightUse(light, {Model::kPhong, shadows});
  };
  EXPECT_EQ(lightUse(everywhere(), {Model::kToon, ShadowMethod::kHard}), LightUse::kByModel);
  for (const Model model : {Model::kCookTorrance, Model::kWard})
    EXPECT_EQ(lightUse(everywhere(), {model, ShadowMethod::kHard}), LightUse::kByModel);
  EXPECT_EQ(reasonOf([](Light& light) { light.kind = LightKind::kDirectional; }), LightUse::kByKind);
  EXPECT_EQ(reasonOf([](Light& light) { light.kind = LightKind::kSpot; }), LightUse::kByKind);
  EXPECT_EQ(reasonOf([](Light& light) { light.range = 1e30f; }), LightUse::kByRange);
  EXPECT_EQ(reasonOf([](Light& light) { light.attenuation = {1e-30f, 0, 1}; }), LightUse::kByAttenuation);
  EXPECT_EQ(reasonOf([](Light& light) { light.attenuation = {0, 1, 1}; }), LightUse::kByAttenuation);
  EXPECT_EQ(reasonOf([](Light& light) { light.attenuation = {1, 0, 0}; }), LightUse::kByAttenuation);
  EXPECT_EQ(reasonOf([](Light& light) { light.ambient.z = 1e-30f; }), LightUse::kByAmbient);
  EXPECT_EQ(reasonOf([](Light& light) { light.shadow = true; }), LightUse::kByShadow);
  EXPECT_EQ(reasonOf([](Light& light) { light.shadow = true; }, ShadowMethod::kOff), LightUse::kClustered);
}

TEST(LightUse, ALightThatCastsIsSampledWhereRaysKnowItsShadow) {
  Light light = everywhere();
  light.shadow = true;
  light.radius = 0.1f;
  const auto useWith = [&](ShadowMethod shadows) { return lightUse(light, {Model::kPhong, shadows}); };
  EXPECT_EQ(useWith(ShadowMethod::kExact), LightUse::kSampled);
  EXPECT_EQ(useWith(ShadowMethod::kAuto), LightUse::kSampled);
  EXPECT_EQ(useWith(ShadowMethod::kSoftExact), LightUse::kByShadow);
  for (const ShadowMethod by_map : {ShadowMethod::kHard, ShadowMethod::kPcf, ShadowMethod::kSoft})
    EXPECT_EQ(useWith(by_map), LightUse::kByShadow);
  light.radius = 0;
  EXPECT_EQ(useWith(ShadowMethod::kSoftExact), LightUse::kSampled);
  light.range = 3;
  EXPECT_EQ(useWith(ShadowMethod::kExact), LightUse::kByRange);
}

TEST(LightUse, EveryLightIsCountedOnce) {
  std::vector<Light> lights(10000, everywhere());
  for (std::size_t i = 0; i < lights.size(); i += 4) lights[i].kind = LightKind::kSpot;
  for (std::size_t i = 1; i < lights.size(); i += 4) lights[i].range = 3;
  const auto counts = countUses(lights, {Model::kPhong, ShadowMethod::kExact});
  EXPECT_EQ(counts[std::size_t(LightUse::kClustered)], 5000u);
  EXPECT_EQ(counts[std::size_t(LightUse::kByKind)], 2500u);
  EXPECT_EQ(counts[std::size_t(LightUse::kByRange)], 2500u);
}

}  // namespace
}  // namespace luciole::test
