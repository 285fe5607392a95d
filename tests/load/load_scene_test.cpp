#include "luciole/load_scene.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "luciole/error.hpp"
#include "scene/warning_texts.hpp"
#include "shared_files.hpp"

namespace luciole {
namespace {

using test::textsOf;
using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;

class LoadScene : public testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) {
    std::ofstream(folder / name) << text;
    return folder / name;
  }
  /// A scene of a box, with these members beside.
  Scene load(const std::string& members) {
    return loadScene(write("scene.json", R"({"objects": [{"primitive": "box"}])" + members + "}"));
  }
  std::string refusal(const std::string& path) {
    try {
      loadScene(path);
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  }
  const test::TemporaryFolder folder;
};

TEST_F(LoadScene, ASceneFileThatSaysNothingOfLightIsLitAsABareMesh) {
  write("box.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  const Scene mesh = loadScene(folder / "box.obj");
  const Scene scene = loadScene(write("scene.json", R"({"objects": [{"mesh": "box.obj"}]})"));
  ASSERT_EQ(scene.lights.size(), mesh.lights.size());
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    EXPECT_EQ(scene.lights[i].direction, mesh.lights[i].direction);
    EXPECT_EQ(scene.lights[i].diffuse, mesh.lights[i].diffuse);
    EXPECT_EQ(scene.lights[i].shadow, mesh.lights[i].shadow);
  }
  EXPECT_EQ(scene.ambient, mesh.ambient);
  EXPECT_EQ(scene.background, glm::vec3(0)) << "which has a default of its own";
  EXPECT_THAT(textsOf(scene.warnings), IsEmpty());
}

TEST_F(LoadScene, WhatASceneFileSaysOfLightIsKept) {
  for (const char* members :
       {R"(, "ambient": 0.5)", R"(, "lighting": false)", R"(, "materials": {"lamp": {"emission": 1}})",
        R"(, "lights": [{"type": "directional", "direction": [0,-1,0]}])",
        R"(, "light_fields": [{"count": 1, "min": [0,0,0], "max": [1,1,1]}])",
        R"(, "lights": [], "ambient": 0.5)"}) {
    const Scene scene = load(members);
    EXPECT_LE(scene.lights.size(), 1u) << members;
    EXPECT_THAT(textsOf(scene.warnings), IsEmpty()) << members;
  }
}

TEST_F(LoadScene, ASceneThatNothingLightsIsWarnedOf) {
  for (const char* members :
       {R"(, "lights": [])",
        R"(, "lights": [{"type": "directional", "direction": [0,-1,0], "enabled": false}])",
        R"(, "ambient": 0)"}) {
    const Scene scene = load(members);
    EXPECT_THAT(scene.lights, IsEmpty()) << members;
    EXPECT_THAT(textsOf(scene.warnings), ElementsAre(EndsWith("scene.json: nothing lights this scene")))
        << members;
  }
  const Scene empty = loadScene(write("scene.json", R"({"fog": {"mode": "exp"}})"));
  EXPECT_THAT(empty.lights, IsEmpty()) << "there is nothing to frame, but a G-buffer may be lit by it";
  EXPECT_THAT(textsOf(empty.warnings), ElementsAre(EndsWith("scene.json: nothing lights this scene")));
}

TEST_F(LoadScene, AllThatIsMissingIsToldAtOnce) {
  std::string materials;
  for (int i = 0; i < 12; ++i)
    materials += fmt::format(R"({}"m{}": {{"diffuse_map": "gone{}.png"}})", i ? ", " : "", i, i);
  const std::string path = write("scene.json", R"({"materials": {)" + materials + "}}");
  const std::string told = refusal(path);
  EXPECT_THAT(told, HasSubstr("gone0.png"));
  EXPECT_THAT(told, HasSubstr("gone7.png"));
  EXPECT_THAT(told, EndsWith("; and 2 more"));
}

TEST_F(LoadScene, AMissingTextureIsAnErrorOrAWarning) {
  const std::string path = write("scene.json", R"({"lights": [{"type": "directional", "direction": [0,-1,0]}],
      "materials": {"m": {"diffuse_map": "gone.png"}}, "objects": [{"primitive": "box", "material": "m"}]})");
  const std::string fault =
      fmt::format("{}: materials.m.diffuse_map: there is no file {}", path, folder / "gone.png");
  EXPECT_EQ(refusal(path), fault);
  const Scene scene = loadScene(path, 1, {.missing = MissingTextures::kWarn});
  EXPECT_THAT(textsOf(scene.warnings), ElementsAre(fault + "; drawn without"));
  EXPECT_EQ(scene.objects.size(), 1u);
}

}  // namespace
}  // namespace luciole
