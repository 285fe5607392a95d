#include "scene/place_limits.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "luciole/load_scene.hpp"
#include "luciole/pose.hpp"
#include "scene/gltf/gltf_file.hpp"

namespace luciole {
namespace {

using namespace test;
using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

class PlaceLimits : public GltfTest {
 protected:
  std::string refusal(const std::string& path, double frame = 1) {
    try {
      loadScene(path, frame);
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  }
  std::string ofNode(const json& members) {
    GltfFile file = triangleFile();
    file.root["nodes"][0].update(members);
    return ofFile(file);
  }
  std::string ofFile(const GltfFile& file) {
    load(file);  // the loader itself knows no limit but float's
    return refusal(folder / "a.gltf");
  }
  std::string ofText(const std::string& name, const std::string& text) {
    std::ofstream(folder / name) << text;
    return refusal(folder / name);
  }
};

TEST_F(PlaceLimits, HoldForMeshFilesAfterAllTransforms) {
  const auto fault = [&](const char* file) {
    return AllOf(StartsWith(folder / file + ": object 0 '"), HasSubstr("a vertex's coordinate of "),
                 HasSubstr("expected 1e+18 at most"));
  };
  EXPECT_THAT(ofNode({{"scale", {1e38, 1e38, 1e38}}}), fault("a.gltf"));
  EXPECT_THAT(ofNode({{"translation", {0, -1.1e18, 0}}}), fault("a.gltf"));
  EXPECT_EQ(ofNode({{"translation", {0, -1e18, 0}}}), "no error");
  GltfFile far = triangleFile();
  far.primitive()["attributes"]["POSITION"] =
      far.addAccessor<float>("VEC3", kFloat, 3, {0, 0, 0, 1e38f, 0, 0, 0, 1, 0});
  EXPECT_THAT(ofFile(far), fault("a.gltf"));
  far.root["nodes"][0]["scale"] = {1e-21, 1, 1};
  EXPECT_EQ(ofFile(far), "no error") << "where it ends up counts";
  EXPECT_THAT(ofText("far.obj", "v 0 0 0\nv 1 0 0\nv 0 0 2e18\nf 1 2 3\n"), fault("far.obj"));
  EXPECT_EQ(ofText("near.obj", "v 0 0 0\nv 1 0 0\nv 0 0 9e17\nf 1 2 3\n"), "no error");
  EXPECT_THAT(ofText("scene.json", R"({"objects": [{"mesh": "near.obj", "scale": 2}]})"),
              fault("scene.json"));
}

TEST_F(PlaceLimits, HoldForLightsCamerasAndPosesToo) {
  GltfFile file = triangleFile();
  file.root["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
  file.root["nodes"].push_back(
      {{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}, {"translation", {0, 2e18, 0}}});
  file.root["scenes"][0]["nodes"] = {0, 1};
  EXPECT_THAT(ofFile(file), HasSubstr("light 0: a coordinate of 2e+18"));
  file.root["nodes"][1] = {{"camera", 0}, {"translation", {0, 2e18, 0}}};
  file.root["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 1}}}}};
  EXPECT_THAT(ofFile(file), HasSubstr("camera 0 '': a coordinate of 2e+18"));
  file.root["nodes"][1] = {{"camera", 0}, {"scale", {1e200, 1e200, 1e200}}};
  EXPECT_EQ(ofFile(file), "no error") << "left out with a warning, for its scale leaves it no direction";
  file.root["nodes"][1].erase("scale");
  file.root["cameras"] = {
      {{"type", "orthographic"}, {"orthographic", {{"xmag", 1}, {"ymag", 1e30}, {"znear", 1}, {"zfar", 2}}}}};
  EXPECT_THAT(ofFile(file), HasSubstr("half a picture's height of 1e+30"));
  const std::string moving = folder / "moving.json";
  std::ofstream(moving) << R"({"objects": [{"primitive": "box", "translate": [0,0,0], "scale": 1, "keys": [
      {"frame": 1, "scale": 1, "translate": [0,0,0]}, {"frame": 3, "scale": 9e17, "translate": [9e17,0,0]}]}]})";
  EXPECT_EQ(refusal(moving, 1), "no error");
  EXPECT_THAT(refusal(moving, 3), HasSubstr("a vertex's coordinate of 1.35e+18"));
}

}  // namespace
}  // namespace luciole
