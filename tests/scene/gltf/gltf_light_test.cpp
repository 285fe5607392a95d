// Lights of glTF files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "base/error.hpp"
#include "scene/gltf/gltf_loader.hpp"
#include "scene/warning_texts.hpp"

namespace luciole::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST_F(GltfLoader, ALambertianSurfaceIsAsBrightAsGltfSays) {
  // Base colour over pi times the illuminance: with our Kd N.L the light carries the 1/pi.
  const Light l = light({{"type", "point"}, {"color", {1, 0.5, 0}}, {"intensity", 10}, {"range", 4}});
  EXPECT_EQ(l.kind, LightKind::kPoint);
  EXPECT_NEAR(l.diffuse.x, 10 / kPi, 10 / kPi * kColorTolerance);
  EXPECT_NEAR(l.diffuse.y, 5 / kPi, 5 / kPi * kColorTolerance);
  EXPECT_EQ(l.specular, l.diffuse);
  EXPECT_EQ(l.ambient, glm::vec3(0));
  EXPECT_EQ(l.attenuation, glm::vec3(0, 0, 1));
  EXPECT_EQ(l.range, 4.0f);
  EXPECT_EQ(l.window, RangeWindow::kKhr);
  EXPECT_EQ(l.position, glm::dvec3(1, 2, 3));
}

TEST_F(GltfLoader, DirectionalLightsDoNotFallOff) {
  const Light l = light({{"type", "directional"}});
  EXPECT_EQ(l.kind, LightKind::kDirectional);
  EXPECT_EQ(l.direction, glm::dvec3(0, 0, -1));
  EXPECT_EQ(l.attenuation, glm::vec3(1, 0, 0));
  EXPECT_EQ(l.range, std::numeric_limits<float>::infinity());
}

TEST_F(GltfLoader, SpotLightsHaveTheirCones) {
  const Light l = light({{"type", "spot"}, {"spot", {{"innerConeAngle", 0.25}, {"outerConeAngle", 0.5}}}});
  EXPECT_EQ(l.kind, LightKind::kSpot);
  EXPECT_EQ(l.falloff, SpotFalloff::kCone);
  EXPECT_EQ(l.cutoff, 0.5);
  EXPECT_EQ(l.inner_cone, 0.25);
  const Light sharp = light({{"type", "spot"}, {"spot", {{"innerConeAngle", 0.5}, {"outerConeAngle", 0.5}}}});
  EXPECT_LT(sharp.inner_cone, sharp.cutoff);
  EXPECT_THROW(light({{"type", "spot"}, {"spot", {{"innerConeAngle", 0.6}, {"outerConeAngle", 0.5}}}}),
               InputError);
  EXPECT_THROW(light({{"type", "spot"}, {"spot", {{"outerConeAngle", 2}}}}), InputError);
}

TEST_F(GltfLoader, ExtrasOfANodeOrItsLightNameTheLightsGroup) {
  GltfFile file = triangleFile();
  json& lights = file.root["extensions"]["KHR_lights_punctual"]["lights"];
  json& node = file.root["nodes"][0];
  lights = {{{"type", "point"}, {"extras", {{"group", "of the light"}}}}};
  node["extensions"]["KHR_lights_punctual"]["light"] = 0;
  const auto groupName = [&] {
    const Scene scene = load(file);
    return scene.light_groups.at(scene.lights.at(0).group);
  };
  EXPECT_EQ(groupName(), "of the light");
  node["extras"]["group"] = "of the node";
  EXPECT_EQ(groupName(), "of the node");
  node["extras"]["group"] = {1, 2};  // somebody else's
  EXPECT_EQ(groupName(), "of the light");
  node["extras"]["group"] = "a.b";
  EXPECT_EQ(groupName(), "of the light");
  EXPECT_THAT(textsOf(load(file).warnings),
              ElementsAre(HasSubstr("nodes[0]: extras.group: expected a group's name")));
  node.erase("extras");
  lights[0].erase("extras");
  EXPECT_EQ(groupName(), "default");
}

TEST_F(GltfLoader, ImpossibleLightsAreRefused) {
  EXPECT_THROW(light({{"type", "point"}, {"intensity", -1}}), InputError);
  EXPECT_THROW(light({{"type", "point"}, {"range", -1}}), InputError);
  EXPECT_THROW(light({{"type", "point"}, {"intensity", 1e300}}), InputError);
  EXPECT_THROW(light({{"type", "neon"}}), InputError);
}

}  // namespace
}  // namespace luciole::test
