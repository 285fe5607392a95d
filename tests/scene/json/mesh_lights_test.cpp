// "lights" and "cameras" of an object of a scene file: those of its mesh file, placed as its meshes are.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "luciole/error.hpp"
#include "luciole/load_scene.hpp"
#include "luciole/pose.hpp"
#include "scene/json/write_scene.hpp"
#include "shared_files.hpp"

namespace luciole::test {
namespace {

/// A triangle, a lamp of the group "warm", a spot that shines along −z, a sun that shines down, a camera, and
/// a lamp on a node that an animation moves by 2 m along z in a second: 24 frames.
constexpr const char* kRig = R"({
  "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1, 2, 3, 4, 5]}],
  "nodes": [{"mesh": 0, "name": "post"},
            {"translation": [1, 2, 3], "extensions": {"KHR_lights_punctual": {"light": 0}}, "extras": {"group": "warm"}},
            {"translation": [0, 4, 0], "extensions": {"KHR_lights_punctual": {"light": 1}}},
            {"rotation": [-0.7071067811865476, 0, 0, 0.7071067811865476], "extensions": {"KHR_lights_punctual": {"light": 2}}},
            {"camera": 0, "name": "close", "translation": [0, 1, 5]},
            {"extensions": {"KHR_lights_punctual": {"light": 0}}}],
  "cameras": [{"type": "perspective", "perspective": {"yfov": 0.5, "znear": 0.1, "zfar": 50}}],
  "extensionsUsed": ["KHR_lights_punctual"],
  "extensions": {"KHR_lights_punctual": {"lights": [{"type": "point", "range": 7},
      {"type": "spot", "spot": {"outerConeAngle": 0.5}}, {"type": "directional"}]}},
  "animations": [{"channels": [{"sampler": 0, "target": {"node": 5, "path": "translation"}}],
                  "samplers": [{"input": 1, "output": 2}]}],
  "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
  "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [-1, -1, 0], "max": [1, 1, 0]},
                {"bufferView": 1, "componentType": 5126, "count": 2, "type": "SCALAR", "min": [0], "max": [1]},
                {"bufferView": 2, "componentType": 5126, "count": 2, "type": "VEC3"}],
  "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 8},
                  {"buffer": 0, "byteOffset": 44, "byteLength": 24}],
  "buffers": [{"byteLength": 68, "uri": "data:application/octet-stream;base64,AACAvwAAgL8AAAAAAACAPwAAgL8AAAAAAAAAAAAAgD8AAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAAAAAAAAAAAAAEA="}]})";

class MeshLights : public testing::Test {
 protected:
  MeshLights() { std::ofstream(folder / "rig.gltf") << kRig; }
  Scene load(const std::string& text, double frame = 1) {
    std::ofstream(folder / "scene.json") << text;
    return loadScene(folder / "scene.json", frame);
  }
  std::string refusal(const std::string& text) {
    try {
      load(text);
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  }
  TemporaryFolder folder;
};

// Places are sums and products of numbers below 10, rounded to doubles.
void expectNear(const glm::dvec3& a, const glm::dvec3& b) { EXPECT_LT(glm::distance(a, b), 1e-14); }

TEST_F(MeshLights, AreLeftOutUnlessAskedFor) {
  for (const char* keys : {"", R"(, "lights": false, "cameras": false)"}) {
    const Scene scene = load(std::string(R"({"ambient": 1, "objects": [{"mesh": "rig.gltf")") + keys + "}]}");
    EXPECT_TRUE(scene.lights.empty());
    EXPECT_TRUE(scene.adds_camera);
  }
}

TEST_F(MeshLights, FollowTheObjectsPlaceAndTurnButNotItsScale) {
  const Scene scene = load(R"({"objects": [{"mesh": "rig.gltf", "lights": true, "cameras": true,
      "scale": 2, "rotate": [0, 90, 0], "translate": [10, 0, 0]}]})");
  ASSERT_EQ(scene.lights.size(), 4u);
  // (x, y, z) turns to (z, y, −x).
  expectNear(scene.lights[0].position, {10 + 6, 4, -2});
  EXPECT_EQ(scene.lights[0].range, 7);
  EXPECT_EQ(scene.light_groups[scene.lights[0].group], "warm");
  expectNear(scene.lights[1].position, {10, 8, 0});
  expectNear(scene.lights[1].direction, {-1, 0, 0});
  expectNear(scene.lights[2].direction, {0, -1, 0});
  EXPECT_EQ(scene.light_groups[scene.lights[2].group], "default");
  ASSERT_EQ(scene.cameras.size(), 1u);
  EXPECT_FALSE(scene.adds_camera);
  EXPECT_EQ(scene.cameras[0].name, "close");
  expectNear(scene.cameras[0].camera_to_world[3], {20, 2, 0});
  expectNear(scene.cameras[0].camera_to_world[2], {1, 0, 0});
}

TEST_F(MeshLights, AMirrorTurnsWhereTheyShineAndNoCameraInsideOut) {
  const Scene scene =
      load(R"({"objects": [{"mesh": "rig.gltf", "lights": true, "cameras": true, "scale": [1, 1, -1]}]})");
  expectNear(scene.lights[1].direction, {0, 0, 1});
  const glm::dmat4& camera = scene.cameras[0].camera_to_world;
  expectNear(camera[2], {0, 0, -1});
  EXPECT_GT(glm::determinant(glm::dmat3(camera)), 0);
}

TEST_F(MeshLights, EachPlacementHasItsOwn) {
  const Scene scene = load(R"({"camera": {"eye": [0, 0, 9], "target": [0, 0, 0]},
    "lights": [{"type": "point", "position": [0, 0, 0], "group": "warm"}],
    "objects": [{"mesh": "rig.gltf", "lights": true, "cameras": true, "name": "left", "translate": [-5, 0, 0]},
                {"mesh": "rig.gltf"},
                {"mesh": "rig.gltf", "lights": true, "cameras": true, "name": "right", "translate": [5, 0, 0]}]})");
  ASSERT_EQ(scene.lights.size(), 9u);
  EXPECT_EQ(scene.lights[1].group, scene.lights[0].group) << "a group of one name is one";
  expectNear(scene.lights[1].position, {-4, 2, 3});
  expectNear(scene.lights[5].position, {6, 2, 3});
  ASSERT_EQ(scene.cameras.size(), 3u);
  EXPECT_EQ(scene.cameras[0].name, "");
  EXPECT_EQ(scene.cameras[1].name, "left") << "as a part is called that is the only one";
  EXPECT_EQ(scene.cameras[2].name, "right");
  EXPECT_EQ(scene.meshes.size(), 1u) << "the file is loaded once";
}

TEST_F(MeshLights, MoveWithTheFileAndWithTheObject) {
  const char* text = R"({"objects": [{"mesh": "rig.gltf", "lights": true, "cameras": true, "keys": [
      {"frame": 1, "translate": [0, 0, 0], "rotate": [0, 0, 0]}, {"frame": 25, "translate": [8, 0, 0], "rotate": [0, 90, 0]}]}]})";
  const Scene first = load(text);
  expectNear(first.lights[3].position, {0, 0, 0});
  expectNear(first.lights[1].direction, {0, 0, -1});
  const Scene last = load(text, 25);
  expectNear(last.lights[3].position, {8 + 2, 0, 0});
  expectNear(last.lights[0].position, {8 + 3, 2, -1});
  expectNear(last.lights[1].direction, {-1, 0, 0});
  expectNear(last.cameras[0].camera_to_world[3], {8 + 5, 1, 0});
  const Scene still =
      load(R"({"objects": [{"mesh": "rig.gltf", "lights": true, "translate": [8, 0, 0]}]})", 25);
  expectNear(still.lights[3].position, {8, 0, 2});
}

TEST_F(MeshLights, AreOfGltfFilesAlone) {
  std::ofstream(folder / "t.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  EXPECT_THAT(refusal(R"({"objects": [{"mesh": "t.obj", "lights": true}]})"),
              testing::EndsWith("objects[0].lights: an .obj file has no lights, only glTF files have"));
  EXPECT_THAT(refusal(R"({"objects": [{"primitive": "box", "cameras": true}]})"),
              testing::EndsWith("objects[0].cameras: means nothing beside primitive"));
  EXPECT_THAT(refusal(R"({"objects": [{"mesh": "rig.gltf", "lights": 1}]})"),
              testing::HasSubstr("objects[0].lights: "));
}

TEST_F(MeshLights, AreReplacedWithAScenesOther) {
  const Scene scene = load(R"({"objects": [{"mesh": "rig.gltf", "lights": true, "cameras": true}]})");
  const std::string text =
      sceneWithLights(folder / "scene.json", folder.path().string(), scene.cameras[0], {Light{}});
  EXPECT_EQ(load(text).lights.size(), 1u);
}

}  // namespace
}  // namespace luciole::test
