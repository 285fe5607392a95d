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
  EXPECT_EQ(reasonOf([](Light& light) { light.kind = LightKind::kSpot; }), LightUse::kByKind);
  EXPECT_EQ(reasonOf([](Light& light) { light.range = 1e30f; }), LightUse::kByRange);
  EXPECT_EQ(reasonOf([](Light& light) { light.attenuation = {1e-30f, 0, 1}; }), LightUse::kByAttenuation);
  EXPECT_EQ(reasonOf([](Light& light) { light.attenuation = {0, 1, 1}; }), LightUse::kByAttenuation);
  EXPECT_EQ(reasonOf([](Light& light) { light.attenuation = {1, 0, 0}; }), LightUse::kByAttenuation);
  EXPECT_EQ(reasonOf([](Light& light) { light.ambient.z = 1e-30f; }), LightUse::kByAmbient);
  EXPECT_EQ(reasonOf([](Light& light) { light.shadow = true; }), LightUse::kByShadow);
  EXPECT_EQ(reasonOf([](Light& light) { light.shadow = true; }, ShadowMethod::kOff), LightUse::kClustered);
}

/// What a flat face sends out.
Light face() {
  Light light = everywhere();
  light.kind = LightKind::kSpot;
  light.cutoff = glm::radians(90.0);
  light.exponent = 1;
  return light;
}

TEST(LightUse, FacesAndPartsOfSourcesAreSampledThoughTheyCastNothing) {
  const UseConditions conditions{Model::kBlinnPhong, ShadowMethod::kHard};
  EXPECT_EQ(lightUse(face(), conditions), LightUse::kSampled);
  Light part = everywhere();
  part.cell = 1e-6f;
  EXPECT_EQ(lightUse(part, conditions), LightUse::kSampled);
  const auto useOf = [&](auto change) {
    Light light = face();
    change(light);
    return lightUse(light, conditions);
  };
  EXPECT_EQ(useOf([](Light& light) { light.shadow = true; }), LightUse::kByShadow);
  EXPECT_EQ(useOf([](Light& light) { light.cutoff -= 1e-6; }), LightUse::kByKind);
  EXPECT_EQ(useOf([](Light& light) { light.exponent = 1.001f; }), LightUse::kByKind);
  EXPECT_EQ(useOf([](Light& light) { light.falloff = SpotFalloff::kCone; }), LightUse::kByKind);
  EXPECT_EQ(useOf([](Light& light) { light.range = 9; }), LightUse::kByRange);
}

// Its place, range and attenuation mean nothing.
TEST(LightUse, DirectionalLightsAreSampledByThemselves) {
  Light light{.kind = LightKind::kDirectional, .position = glm::dvec3(1e30), .attenuation = {1, 1, 0}};
  const auto use = [&](ShadowMethod shadows) { return lightUse(light, {Model::kPhong, shadows}); };
  EXPECT_EQ(use(ShadowMethod::kHard), LightUse::kSampledDirection);
  light.shadow = true;
  EXPECT_EQ(use(ShadowMethod::kExact), LightUse::kSampledDirection);
  EXPECT_EQ(use(ShadowMethod::kSoftExact), LightUse::kSampledDirection);
  EXPECT_EQ(use(ShadowMethod::kHard), LightUse::kByShadow);
  light.half_angle = 0.01;
  EXPECT_EQ(use(ShadowMethod::kExact), LightUse::kSampledDirection);
  EXPECT_EQ(use(ShadowMethod::kSoftExact), LightUse::kByShadow);
  light.ambient.y = 0.1f;
  EXPECT_EQ(use(ShadowMethod::kExact), LightUse::kByAmbient);
}

TEST(LightUse, OnlyLightsOfTheUseThatCastAreCounted) {
  std::vector<Light> lights(100, face());
  for (std::size_t i = 0; i < 30; ++i) lights[i].shadow = true;
  for (std::size_t i = 0; i < 10; ++i) lights[i].kind = LightKind::kDirectional;
  const auto count = [&](LightUse use, ShadowMethod shadows) {
    return countCasting(lights, use, {Model::kPhong, shadows});
  };
  EXPECT_EQ(count(LightUse::kSampled, ShadowMethod::kExact), 20u);
  EXPECT_EQ(count(LightUse::kSampledDirection, ShadowMethod::kExact), 10u);
  EXPECT_EQ(count(LightUse::kSampled, ShadowMethod::kOff), 0u);
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
