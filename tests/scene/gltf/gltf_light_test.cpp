// Lights of glTF files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "luciole/error.hpp"
#include "luciole/pose.hpp"
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

TEST_F(GltfLoader, ImpossibleLightsAreMendedOrLeftOut) {
  const auto mended = [&](const json& source, const char* what) {
    GltfFile file = triangleFile();
    file.root["extensions"]["KHR_lights_punctual"]["lights"] = {source};
    file.root["nodes"][0]["extensions"]["KHR_lights_punctual"]["light"] = 0;
    EXPECT_THAT(repair(file), HasSubstr(std::string("extensions.KHR_lights_punctual.lights[0]: ") + what));
    return load(file).lights;
  };
  EXPECT_EQ(mended({{"type", "point"}, {"intensity", -1}}, "intensity is -1").at(0).diffuse, glm::vec3(0));
  EXPECT_EQ(mended({{"type", "point"}, {"color", {1, -2, 1}}}, "color has -2").at(0).diffuse.y, 0.0f);
  for (const double range : {-1.0, 0.0})
    EXPECT_EQ(mended({{"type", "point"}, {"range", range}}, "range is ").at(0).range, INFINITY);
  EXPECT_TRUE(mended({{"type", "neon"}}, "type is 'neon'").empty());
  EXPECT_EQ(mended({{"type", "Point"}}, "type is 'Point'").at(0).kind, LightKind::kPoint);
  const auto cone = [](double inner, double outer) {
    return json{{"type", "spot"}, {"spot", {{"innerConeAngle", inner}, {"outerConeAngle", outer}}}};
  };
  Light spot = mended(cone(0.6, 0.5), "innerConeAngle is 0.6, taken for 0.5").at(0);
  EXPECT_EQ(spot.cutoff, 0.5);
  EXPECT_NEAR(spot.inner_cone, 0.5, 1e-6);
  spot = mended(cone(0.6, 2), "outerConeAngle is 2, taken for pi/2").at(0);
  EXPECT_EQ(spot.cutoff, kPi / 2);
  EXPECT_EQ(spot.inner_cone, 0.6);
  EXPECT_EQ(mended(cone(-0.5, 1), "innerConeAngle is -0.5").at(0).inner_cone, 0);
  EXPECT_TRUE(mended(cone(0, 0), "outerConeAngle is 0").empty());
  EXPECT_EQ(
      mended({{"type", "point"}, {"color", {0.5, 0.25}}}, "color has 2 numbers, expected 3").at(0).diffuse,
      glm::vec3(glm::dvec3(0.5, 0.25, 1) / kPi));
  EXPECT_THROW(light({{"type", "point"}, {"intensity", 1e300}}), InputError);
}

TEST_F(GltfLoader, LampsThatAScaleOfZeroHidesForAWhileAreDarkMeanwhile) {
  GltfFile file = triangleFile();
  file.root["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "spot"}}, {{"type", "point"}}};
  file.root["nodes"] = {{{"mesh", 0}}, {{"scale", {0, 0, 0}}, {"children", {2, 3}}}};
  for (const int lamp : {0, 1})
    file.root["nodes"].push_back(
        {{"translation", {2, 0, 0}}, {"extensions", {{"KHR_lights_punctual", {{"light", lamp}}}}}});
  file.root["scenes"][0]["nodes"] = {0, 1};
  const int times = file.addAccessor<float>("SCALAR", kFloat, 1, {0, 1, 2});
  const int scales = file.addAccessor<float>("VEC3", kFloat, 3, {0, 0, 0, 1, 1, 1, 0, 0, 0});
  file.root["animations"] = {{{"channels", {{{"sampler", 0}, {"target", {{"node", 1}, {"path", "scale"}}}}}},
                              {"samplers", {{{"input", times}, {"output", scales}}}}}};
  Scene scene = load(file);
  EXPECT_TRUE(scene.warnings.empty());
  ASSERT_EQ(scene.lights.size(), 2u);
  for (int round = 0; round < 2; ++round) {
    for (const double frame : {1, 1, 25, 25, 49}) {
      poseScene(scene, frame);
      for (const Light& lamp : scene.lights) {
        EXPECT_EQ(lamp.diffuse, glm::vec3(frame == 25 ? float(1 / kPi) : 0.0f)) << frame;
        EXPECT_EQ(lamp.specular, lamp.diffuse);
        EXPECT_TRUE(frame != 25 || lamp.position == glm::dvec3(2, 0, 0));
      }
    }
  }
}

TEST_F(GltfLoader, LampsAndCamerasBelowAScaleOfZeroAreLeftOutWithAWarning) {
  GltfFile file = triangleFile();
  file.root["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "spot"}}, {{"type", "point"}}};
  file.root["cameras"] = {
      {{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}, {"zfar", 9}}}}};
  file.root["nodes"] = {{{"mesh", 0}}, {{"scale", {0, 0, 0}}, {"children", {2, 3, 4}}}, {{"camera", 0}}};
  for (const int lamp : {0, 1})
    file.root["nodes"].push_back({{"extensions", {{"KHR_lights_punctual", {{"light", lamp}}}}}});
  file.root["scenes"][0]["nodes"] = {0, 1};
  const Scene scene = load(file);
  EXPECT_TRUE(scene.lights.empty());
  EXPECT_TRUE(scene.cameras.empty());
  EXPECT_EQ(scene.objects.size(), 1u);
  EXPECT_THAT(textsOf(scene.warnings),
              ElementsAre(HasSubstr("nodes[2]: its scale leaves a camera no direction; left out"),
                          HasSubstr("nodes[3]: its scale is 0; left out"),
                          HasSubstr("nodes[4]: its scale is 0; left out")));
  for (const Warning& warning : scene.warnings) EXPECT_FALSE(warning.repaired) << warning.text;
}

}  // namespace
}  // namespace luciole::test
