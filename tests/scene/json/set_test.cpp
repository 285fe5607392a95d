// --set: places of a scene that get another value.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "luciole/error.hpp"
#include "luciole/load_scene.hpp"
#include "scene/json/json_scene.hpp"
#include "scene/json/scene_changes.hpp"
#include "shared_files.hpp"

namespace luciole::test {
namespace {

using testing::HasSubstr;

constexpr const char* kScene = R"({
  "cameras": {"front": {"eye": [0, 0, 5], "target": [0, 0, 0]}, "above": {"eye": [0, 5, 1], "target": [0, 0, 0]}},
  "fog": {"mode": "exp", "density": 0.2},
  "materials": {"box": {"diffuse": [0.5, 0.5, 0.5]}, "a.b": {"diffuse": 0.25}},
  "objects": [{"primitive": "box", "material": "box", "name": "crate"}, {"primitive": "plane", "material": "a.b"}],
  "lights": [{"type": "point", "position": [0, 3, 0], "name": "lamp"},
             {"type": "directional", "direction": [0, -1, 0]}]})";

Scene changed(const std::vector<std::string>& changes) {
  return parseJsonScene(kScene, "scene.json", {}, readChanges(changes)).scene;
}

std::string faultOf(const std::string& change) {
  try {
    changed({change});
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Set, ReachesEveryPlaceOfASceneFile) {
  const Scene scene =
      changed({"materials.box.shininess=4", "materials.box.diffuse[1]=0.75",
               R"(materials["a.b"].shininess=2)", "materials.box.model=blinn-phong", "cameras.above.fov_y=30",
               "fog.density=[1,2,3]", "lights[1].intensity=0.5", "lights.lamp.color=[1,0,0]",
               "objects.crate.translate=[0,1,0]", "ambient=0.125", "size=[64,32]"});
  EXPECT_EQ(scene.materials[2].shininess, 4);
  EXPECT_EQ(scene.materials[2].diffuse, glm::vec3(0.5f, 0.75f, 0.5f));
  EXPECT_EQ(scene.materials[1].shininess, 2);
  EXPECT_EQ(scene.materials[2].model, Model::kBlinnPhong);
  EXPECT_NEAR(scene.cameras[1].fov_y, glm::radians(30.0), 1e-12);
  EXPECT_EQ(scene.cameras[0].name, "front") << "the first stays the default";
  EXPECT_EQ(scene.fog.density, glm::vec3(1, 2, 3));
  EXPECT_EQ(scene.lights[1].diffuse, glm::vec3(0.5f));
  EXPECT_EQ(scene.lights[0].diffuse, glm::vec3(1, 0, 0));
  EXPECT_EQ(scene.objects[0].object_to_world[3].y, 1);
  EXPECT_EQ(scene.ambient, glm::vec3(0.125f));
  EXPECT_EQ(scene.size, glm::ivec2(64, 32));
}

TEST(Set, AnElementOfAColorThatIsOneNumberIsToldToHaveNoMembers) {
  EXPECT_THAT(faultOf(R"(materials["a.b"].diffuse[0]=1)"), HasSubstr("has no materials.a.b.diffuse[0]"));
}

TEST(Set, ReplacesAllLightsOrOne) {
  EXPECT_TRUE(changed({"lights=[]"}).lights.empty());
  const Scene one = changed({R"(lights=[{"type":"point","position":[1,2,3]}])"});
  ASSERT_EQ(one.lights.size(), 1u);
  EXPECT_EQ(one.lights[0].position, glm::dvec3(1, 2, 3));
  EXPECT_EQ(changed({R"(lights[1]={"type":"point","position":[1,2,3]})"}).lights[1].kind, LightKind::kPoint);
}

TEST(Set, TheLastOfSeveralForOnePlaceCounts) {
  EXPECT_EQ(changed({"materials.box.shininess=4", "materials.box.shininess=8"}).materials[2].shininess, 8);
}

TEST(Set, APlaceThatIsNotThereIsToldWithASuggestion) {
  EXPECT_EQ(faultOf("materials.bix.shininess=4"),
            "changes: materials.bix.shininess=4: scene.json has no materials.bix; did you mean box?");
  EXPECT_THAT(faultOf("lights[2].intensity=1"), HasSubstr("has no lights[2]; it has lights[0] to lights[1]"));
  EXPECT_THAT(faultOf("cameras.abov.fov_y=30"), HasSubstr("did you mean above?"));
  EXPECT_THAT(faultOf("camera.fov_y=30"), HasSubstr("has no camera; did you mean cameras?"));
  EXPECT_THAT(faultOf("objects[5].translate=[0,0,0]"), HasSubstr("has no objects[5]; it has [0] to [1]"));
  EXPECT_THAT(faultOf("materials.box.shinines=4"),
              HasSubstr("unknown key \"shinines\" (did you mean \"shininess\"?)"));
  EXPECT_THAT(faultOf("materials.box.shininess=many"),
              HasSubstr("materials.box.shininess: expected a finite number"));
  EXPECT_THAT(faultOf("lights[0].intensity=-1"),
              HasSubstr("lights[0].intensity: expected a number of 0 or more"));
}

TEST(Set, WhatIsNoPlaceIsToldHowOneLooks) {
  for (const char* text :
       {"", "=4", "materials", "materials.box.=4", "a..b=1", "lights[x].range=1", "lights[0=1",
        "lights[0]range=1", R"(a["b]=1)", "lights[-1].range=2", "lights[]=1", "a[99999999999999999999999]=1"})
    EXPECT_THAT(faultOf(text), HasSubstr("expected PATH=VALUE")) << text;
}

/// A mesh file whose material is called by its file.
class SetOfAMesh : public testing::Test {
 protected:
  SetOfAMesh() {
    writeText(folder / "a.mtl", "newmtl red\nKd 0.5 0 0\nKa 0.1 0 0\nKs 0.25 0.25 0.25\nNs 8\n");
    writeText(folder / "a.obj", "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\n");
  }
  Scene load(std::vector<std::string> changes) const {
    LoadSettings settings;
    settings.changes = std::move(changes);
    return loadScene(folder / "a.obj", 1, settings);
  }
  std::string faultOf(const std::string& change) const {
    try {
      load({change});
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
  const Material& red(const Scene& scene) const {
    for (const Material& material : scene.materials)
      if (material.name == "red") return material;
    throw InputError("no red");
  }
  const TemporaryFolder folder;
};

TEST_F(SetOfAMesh, LeavesWhatItDoesNotSay) {
  const Scene scene = load({"materials.red.shininess=64", "materials.red.diffuse=[0,1,0]"});
  EXPECT_EQ(red(scene).shininess, 64);
  EXPECT_EQ(red(scene).diffuse, glm::vec3(0, 1, 0));
  EXPECT_EQ(red(scene).ambient, glm::vec3(0.1f, 0, 0));
  EXPECT_EQ(red(scene).specular, glm::vec3(0.25f));
}

TEST_F(SetOfAMesh, ChangesLightsThatWereAddedToo) {
  const Scene before = load({}),
              after = load({"lights[0].color=[1,0,0]", "lights[1].intensity=2", "ambient=0.5"});
  ASSERT_EQ(before.lights.size(), after.lights.size());
  EXPECT_FLOAT_EQ(after.lights[0].diffuse.x, before.lights[0].diffuse.x) << "as bright";
  EXPECT_EQ(after.lights[0].diffuse.y, 0);
  EXPECT_EQ(after.lights[0].shadow, before.lights[0].shadow);
  EXPECT_FLOAT_EQ(after.lights[1].diffuse.x, 2);
  EXPECT_NEAR(glm::distance(after.lights[1].direction, before.lights[1].direction), 0, 1e-12);
  EXPECT_EQ(after.ambient, glm::vec3(0.5f));
}

TEST_F(SetOfAMesh, IsCheckedAsASceneFileIs) {
  EXPECT_THAT(faultOf("materials.rad.shininess=4"),
              HasSubstr("a.obj has no materials.rad; did you mean red?"));
  EXPECT_THAT(faultOf("materials.red.shinines=4"), HasSubstr("unknown key \"shinines\""));
  EXPECT_THAT(faultOf("materials.red.shininess=x"),
              HasSubstr("materials.red.shininess: expected a finite number"));
  EXPECT_THAT(faultOf("lights[7].intensity=4"), HasSubstr("a.obj has no lights[7]"));
  EXPECT_THAT(faultOf("lights[0].color=[1,2]"), HasSubstr("lights[0].color: expected a colour"));
  EXPECT_THAT(faultOf("camera.fov_y=4"),
              HasSubstr("materials, lights, ambient, background, fog and lighting can be set"));
}

TEST_F(SetOfAMesh, ReachesItsMaterialsFromASceneFileThatUsesIt) {
  writeText(folder / "scene.json", R"({"objects": [{"mesh": "a.obj"}], "ambient": 1})");
  LoadSettings settings;
  settings.changes = {"materials.red.shininess=64"};
  EXPECT_EQ(red(loadScene(folder / "scene.json", 1, settings)).shininess, 64);
}

TEST(LightNames, AreRead) { EXPECT_EQ(changed({}).lights[0].name, "lamp"); }

}  // namespace
}  // namespace luciole::test
