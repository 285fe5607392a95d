// Which lights cast shadows: --cast-shadows, and what is done without it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>

#include "scene/gltf/gltf_file.hpp"
#include "tools/cli/program_test.hpp"

namespace luciole::test {
namespace {

using testing::HasSubstr;
using testing::Not;

/// A floor, a board above it, and a light of glTF's straight above both.
class CastShadows : public ProgramTest {
 protected:
  CastShadows() {
    GltfFile file = triangleFile();
    const int square = file.addAccessor<float>("VEC3", kFloat, 3, {-1, 0, 1, 1, 0, 1, 1, 0, -1, -1, 0, -1});
    const int indices = file.addAccessor<std::uint8_t>("SCALAR", kUnsignedByte, 1, {0, 1, 2, 0, 2, 3});
    file.root["meshes"][0]["primitives"][0] = {{"attributes", {{"POSITION", square}}}, {"indices", indices}};
    const double half = std::sqrt(0.5);
    file.root["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "directional"}, {"intensity", 3}}};
    file.root["nodes"] = {
        {{"mesh", 0}, {"scale", {4, 1, 4}}},
        {{"mesh", 0}, {"translation", {0, 1, 0}}},
        // All its corners lie in the shadow, which Gouraud shading sees by them alone.
        {{"mesh", 0}, {"scale", {0.5, 1, 0.5}}, {"translation", {0, 0.5, 0}}},
        {{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}, {"rotation", {-half, 0, 0, half}}}};
    file.root["scenes"][0]["nodes"] = {0, 1, 2, 3};
    file.root["buffers"] = {{{"byteLength", file.data.size()}, {"uri", "data.bin"}}};
    writeText(folder / "data.bin", file.data);
    writeText(folder / "lamp.gltf", file.root.dump());
    // Of two lights one is marked.
    writeText(folder / "marked.json", R"({"camera": {"eye": [5, 3, 5], "target": [0, 0, 0]},
        "objects": [{"mesh": "lamp.gltf"}],
        "lights": [{"type": "directional", "direction": [0, -1, 0], "shadow": true},
                   {"type": "directional", "direction": [1, -1, 0]}]})");
  }
  void render(const std::string& options, const std::string& output) {
    EXPECT_EQ(run("luciole render " + options + " --size 64x36 --quiet -o " + output).err, "") << options;
  }
  bool areEqual(const std::string& a, const std::string& b) {
    return runLine(folder, "luciole compare " + a + " " + b + " --max-abs 0").status == 0;
  }
};

TEST_F(CastShadows, AskedForAllCastWhereNoneIsMarked) {
  render("lamp.gltf", "plain.exr");
  render("lamp.gltf --shadows off", "off.exr");
  render("lamp.gltf --shadows auto", "asked.exr");
  render("lamp.gltf --cast-shadows all", "all.exr");
  render("lamp.gltf --shadows hard --cast-shadows none", "none.exr");
  EXPECT_TRUE(areEqual("plain.exr", "off.exr")) << "nobody asked";
  EXPECT_TRUE(areEqual("none.exr", "off.exr"));
  EXPECT_TRUE(areEqual("asked.exr", "all.exr"));
  EXPECT_FALSE(areEqual("asked.exr", "off.exr"));
}

TEST_F(CastShadows, WhereSomeAreMarkedOnlyTheyCastUnlessAllAreToldTo) {
  render("marked.json", "plain.exr");
  render("marked.json --shadows auto", "asked.exr");
  render("marked.json --cast-shadows marked", "marked.exr");
  render("marked.json --cast-shadows all", "all.exr");
  EXPECT_TRUE(areEqual("plain.exr", "asked.exr"));
  EXPECT_TRUE(areEqual("plain.exr", "marked.exr"));
  EXPECT_FALSE(areEqual("plain.exr", "all.exr"));
}

TEST_F(CastShadows, HoldForShadeGBufferAndReferenceToo) {
  render("lamp.gltf --shadows exact", "picture.exr");
  run("luciole gbuffer lamp.gltf --size 64x36 -o g.exr");
  run("luciole shade g.exr --scene lamp.gltf --shadows exact -o shaded.exr");
  EXPECT_TRUE(areEqual("picture.exr", "shaded.exr"));
  run("luciole reference lamp.gltf --size 64x36 -o plain_reference.exr");
  run("luciole reference lamp.gltf --size 64x36 --shadows rays -o reference.exr");
  run("luciole reference lamp.gltf --size 64x36 --cast-shadows all -o all_reference.exr");
  EXPECT_TRUE(areEqual("reference.exr", "all_reference.exr"));
  EXPECT_FALSE(areEqual("reference.exr", "plain_reference.exr"));
  run("luciole gbuffer lamp.gltf --size 64x36 --shading gouraud --cast-shadows all -o lit.exr");
  run("luciole gbuffer lamp.gltf --size 64x36 --shading gouraud -o unlit.exr");
  EXPECT_FALSE(areEqual("lit.exr", "unlit.exr"));
}

TEST_F(CastShadows, ShadowsThatNoLightCastsAreToldInOneLine) {
  const std::string line = "luciole render lamp.gltf --size 16x9 -o a.png ";
  EXPECT_THAT(run(line + "--shadows pcf --cast-shadows none").err,
              HasSubstr("luciole: warning: lamp.gltf: --shadows pcf: no light casts shadows\n"));
  for (const char* options : {"", "--shadows pcf", "--shadows off", "--cast-shadows none"})
    EXPECT_THAT(run(line + options).err, Not(HasSubstr("casts"))) << options;
  EXPECT_EQ(runLine(folder, line + "--cast-shadows some").status, 2);
}

}  // namespace
}  // namespace luciole::test
