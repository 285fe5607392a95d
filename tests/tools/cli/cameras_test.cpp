// --camera all: one picture a camera, named by the pattern of -o.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/cli/program_test.hpp"

namespace luciole::test {
namespace {

class AllCameras : public ProgramTest {
 protected:
  /// A scene with cameras of these names at different places.
  void writeScene(const std::string& file, const std::vector<std::string>& names) {
    std::string cameras;
    for (std::size_t i = 0; i < names.size(); ++i)
      cameras +=
          fmt::format(R"({}"{}": {{"eye": [{}, 2, 5], "target": [0, 0.5, 0]}})", i ? ", " : "", names[i], i);
    writeText(folder / file, R"({"cameras": {)" + cameras + R"(}, "size": [32, 18],
      "objects": [{"primitive": "plane", "scale": 10}, {"primitive": "sphere", "translate": [0, 1, 0]}],
      "lights": [{"type": "directional", "direction": [-1, -2, -1], "shadow": true}]})");
  }
};

TEST_F(AllCameras, EachPictureIsThatOfItsCamera) {
  writeScene("scene.json", {"left", "middle", "right"});
  for (const char* line : {"render", "gbuffer", "reference --shadows off"}) {
    succeed(fmt::format("luciole {} scene.json --quiet --camera all -o 'all_{{camera}}.exr'", line));
    for (const char* name : {"left", "middle", "right"}) {
      succeed(fmt::format("luciole {} scene.json --quiet --camera {} -o one.exr", line, name));
      succeed(fmt::format("luciole compare one.exr all_{}.exr --max-abs 0", name));
    }
    succeed("rm all_left.exr all_middle.exr all_right.exr one.exr");
  }
}

TEST_F(AllCameras, NamesWithEndsOfLinesAreToldInOne) {
  writeScene("scene.json", {R"(a\nb\u0007c)"});
  const Outcome outcome = runLine(folder, "luciole render scene.json --camera d -o x.png");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(outcome.err,
            "luciole: --camera d: scene.json has one camera (a b c), by name or counted from 0\n");
}

TEST_F(AllCameras, StatisticsAndFramesHaveTheirOwnNames) {
  writeScene("scene.json", {"a", "b"});
  succeed(
      "luciole render scene.json --quiet --camera all --frames 2-3 -o '{camera}.##.png' --stats "
      "'{camera}.##.json'");
  succeed("rm scene.json");
  EXPECT_EQ(filesIn(folder), (std::vector<std::string>{"a.02.json", "a.02.png", "a.03.json", "a.03.png",
                                                       "b.02.json", "b.02.png", "b.03.json", "b.03.png"}));
  for (const char* name : {"a.02.json", "b.03.json"})
    EXPECT_EQ(nlohmann::json::parse(readText(folder / name))["image"]["width"], 32);
}

TEST_F(AllCameras, ResumeLeavesThoseThatAreThere) {
  writeScene("scene.json", {"a", "b"});
  writeText(folder / "a.2.png", "mine");
  succeed("luciole render scene.json --quiet --camera all --frames 2-3 --resume -o '{camera}.#.png'");
  EXPECT_EQ(readText(folder / "a.2.png"), "mine");
  EXPECT_GT(readText(folder / "b.2.png").size(), 4u);
}

TEST_F(AllCameras, NamesAreMadeFitForFiles) {
  writeScene("scene.json", {"../up", "tower & sea", "caf\xC3\xA9", ".hidden"});
  succeed("luciole gbuffer scene.json --quiet --camera all -o '{camera}.exr' && rm scene.json");
  EXPECT_EQ(filesIn(folder),
            (std::vector<std::string>{"_._up.exr", "_hidden.exr", "caf\xC3\xA9.exr", "tower___sea.exr"}));
}

TEST_F(AllCameras, OneCameraNeedsNoPlaceForItsName) {
  writeScene("scene.json", {"only"});
  succeed(
      "luciole render scene.json --quiet --camera all -o a.png && luciole render scene.json --quiet -o "
      "'{camera}.png'");
  succeed("luciole compare a.png only.png --max-abs 0");
}

TEST_F(AllCameras, CamerasWithoutNamesAreNumbered) {
  LUCIOLE_NEEDS_SHARED();
  const std::string path = (sharedScenes() / "khronos_Cameras/glTF/Cameras.gltf").string();
  succeed("luciole render '" + path + "' --quiet --size 16x16 --camera all -o 'view_{camera}.png'");
  EXPECT_EQ(filesIn(folder), (std::vector<std::string>{"view_0.png", "view_1.png"}));
}

TEST_F(AllCameras, PatternsThatWouldLoseAPictureAreRefused) {
  writeScene("scene.json", {"a b", "a_b", "c"});
  for (const char* line : {"render", "gbuffer", "reference"}) {
    refuse(fmt::format("luciole {} scene.json --quiet --camera all -o a.exr", line), 2, "{camera}");
    refuse(fmt::format("luciole {} scene.json --quiet --camera all -o '{{camera}}.exr'", line), 2,
           "cameras 0 and 1 of scene.json would both be written to a_b.exr");
  }
  refuse("luciole render scene.json --quiet --camera all -o -", 2, "{camera}");
  writeScene("scene.json", {"a", "b"});
  refuse("luciole render scene.json --quiet --camera all -o '{camera}.png' --stats s.json", 2,
         "--stats s.json");
  refuse("luciole render scene.json --quiet --camera all --frames 1-2 -o '#.png'", 2, "{camera}");
  EXPECT_EQ(filesIn(folder), std::vector<std::string>{"scene.json"});
}

}  // namespace
}  // namespace luciole::test
