// What the program says of a scene that it draws, but not as its file asks.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "tools/cli/program_test.hpp"

namespace luciole::test {
namespace {

using testing::HasSubstr;
using testing::Not;

/// One triangle in the xy plane.
constexpr const char* kTriangle = R"({
  "asset": {"version": "2.0"}, "extensionsUsed": ["KHR_materials_transmission"],
  "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
  "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
  "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
  "bufferViews": [{"buffer": 0, "byteLength": 36}],
  "buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]
})";

constexpr const char* kWarning =
    "luciole: warning: triangle.gltf: extensionsUsed: 'KHR_materials_transmission' is not supported";

std::size_t countOf(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

class Warnings : public ProgramTest {
 protected:
  Warnings() {
    writeText(folder / "triangle.gltf", kTriangle);
    writeText(folder / "scene.json", R"({"camera": {"eye": [0, 0, 3], "target": [0, 0, 0]},
        "objects": [{"mesh": "triangle.gltf"}, {"mesh": "triangle.gltf", "translate": [1, 0, 0]}],
        "lights": [{"type": "directional", "direction": [0, 0, -1]}]})");
  }
};

TEST_F(Warnings, AreToldOnceByEveryCommandThatLoadsAScene) {
  for (const char* line :
       {"luciole render triangle.gltf --size 16x9 -o a.png", "luciole render scene.json --size 16x9 -o a.png",
        "luciole render triangle.gltf --size 16x9 --frames 1-3 -o '#.png'",
        "luciole gbuffer triangle.gltf --size 16x9 -o g.exr",
        "luciole shade g.exr --scene triangle.gltf -o b.png",
        "luciole reference triangle.gltf --size 16x9 -o r.exr",
        "luciole generate lights triangle.gltf --count 3 --range 1 -o lights.json"})
    EXPECT_EQ(countOf(told(line), kWarning), 1u) << line;
}

TEST_F(Warnings, AreSilencedByQuietAndStandInTheStatistics) {
  EXPECT_EQ(told("luciole render triangle.gltf --size 16x9 --quiet --stats s.json -o a.png"), "");
  const auto stats = nlohmann::json::parse(readText(folder / "s.json"));
  ASSERT_EQ(stats["warnings"].size(), 1u);
  EXPECT_THAT(stats["warnings"][0].get<std::string>(), HasSubstr("'KHR_materials_transmission'"));
}

TEST_F(Warnings, MissingTexturesAreErrorsUnlessAWarningWillDo) {
  writeText(folder / "holes.json", R"({"camera": {"eye": [0, 3, 3], "target": [0, 0, 0]}, "ambient": 1,
      "materials": {"m": {"diffuse": [0.5, 0.25, 1], "diffuse_map": "gone.png"}},
      "objects": [{"primitive": "plane", "material": "m"}]})");
  const std::string fault = "holes.json: materials.m.diffuse_map: there is no file gone.png";
  const Outcome refused = runLine(folder, "luciole render holes.json --size 16x9 -o a.png");
  EXPECT_EQ(refused.status, 2);
  EXPECT_EQ(refused.err, "luciole: " + fault + "\n");
  EXPECT_EQ(countOf(told("luciole render holes.json --size 16x9 --missing-textures warn -o a.png"),
                    "luciole: warning: " + fault + "; drawn without\n"),
            1u);
  EXPECT_EQ(told("luciole reference holes.json --size 16x9 --missing-textures warn --quiet -o a.exr"), "");
  EXPECT_EQ(runLine(folder, "luciole render holes.json --missing-textures ignore -o a.png").status, 2);
}

TEST_F(Warnings, AreTenOfAKindAtMostAndThenACount) {
  std::string materials;
  for (int i = 0; i < 14; ++i)
    materials += (i ? ", \"m" : "\"m") + std::to_string(i) + R"(": {"diffuse_map": "gone.png"})";
  writeText(folder / "many.json", R"({"ambient": 1, "camera": {"eye": [0, 3, 3], "target": [0, 0, 0]},
      "objects": [{"primitive": "plane"}], "materials": {)" +
                                      materials + "}}");
  const std::string line =
      "luciole render many.json --size 16x9 --missing-textures warn --stats s.json -o a.png";
  const std::string words = told(line);
  EXPECT_EQ(countOf(words, "there is no file gone.png"), 10u);
  EXPECT_THAT(words, HasSubstr("luciole: warning: missing texture: 4 more, which --stats lists\n"));
  EXPECT_EQ(nlohmann::json::parse(readText(folder / "s.json"))["warnings"].size(), 14u);
  EXPECT_EQ(countOf(told(line + " --log json"), "there is no file gone.png"), 14u);
  const std::string info = run("luciole info many.json --missing-textures warn").out;
  EXPECT_EQ(countOf(info, "there is no file"), 10u);
  EXPECT_THAT(info, HasSubstr("missing texture: 4 more, which --json lists\n"));
}

TEST_F(Warnings, AreNoneWhereThereIsNothingToSay) {
  writeText(folder / "plain.json", kSmallScene);
  EXPECT_THAT(told("luciole render plain.json --size 16x9 --stats s.json -o a.png"),
              Not(HasSubstr("warning")));
  EXPECT_EQ(nlohmann::json::parse(readText(folder / "s.json"))["warnings"], nlohmann::json::array());
}

}  // namespace
}  // namespace luciole::test
