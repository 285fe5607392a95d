// --device all: pictures are those of one device, also where another fails in the middle.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "long_run.hpp"
#include "tools/cli/program_test.hpp"

namespace luciole::test {
namespace {

using testing::ContainsRegex;
using testing::HasSubstr;

class SeveralDevices : public ProgramTest {
 protected:
  SeveralDevices() {
    // PoCL's processor under its names until version 4 and since.
    for (const char* name : {"pthread", "cpu"}) {
      two = std::string("export POCL_DEVICES='") + name + " " + name + "'; ";
      const std::string listed = succeed(two + "luciole devices || true");
      if (std::count(listed.begin(), listed.end(), '\n') >= 2) return;
    }
    ADD_FAILURE() << "PoCL has no two devices";
  }

  /// Begins a line whose device that launches the nth kernel fails.
  std::string failingAt(int number) {
    if (!std::filesystem::exists(folder / "failing.so"))
      succeed("cc -shared -fPIC -o failing.so '" LUCIOLE_SOURCE_DIR
              "/tests/tools/cli/failing_device.c' -ldl");
    return two + "export LD_PRELOAD=$PWD/failing.so FAIL_AT=" + std::to_string(number) + "; ";
  }

  std::string two;  ///< begins a line that has two devices
};

std::string scene(const std::string& name) {
  return "'" LUCIOLE_SOURCE_DIR "/scenes/" + name + ".json' --size 120x400 ";
}

TEST_F(SeveralDevices, MakeThePictureOfOne) {
  for (const char* options : {"city --shadows hard", "city --shadows exact", "spheres --shadows soft",
                              "fireflies --light-error 1/64 --samples 4", "cornell --aov shadow,depth"}) {
    const std::string name = std::string(options).substr(0, std::string(options).find(' '));
    const std::string line =
        "luciole render " + scene(name) + std::string(options).substr(name.size()) + " --hash --quiet";
    const std::string one = succeed(line + " -o a.exr");
    EXPECT_EQ(succeed(two + line + " --device all --stats stats.json -o a.exr"), one) << options;
    EXPECT_EQ(succeed(two + line + " --device all,lanes=4 -o a.exr"), one) << options;
    const auto stats = nlohmann::json::parse(readText(folder / "stats.json"));
    ASSERT_EQ(stats["devices"].size(), 2u);
    EXPECT_EQ(stats["devices"][0]["rows"].get<int>() + stats["devices"][1]["rows"].get<int>(), 400);
  }
  EXPECT_EQ(succeed("luciole render " + scene("cornell") + "--hash --quiet --device all -o a.exr"),
            succeed("luciole render " + scene("cornell") + "--hash --quiet -o a.exr"));
}

TEST_F(SeveralDevices, OneThatFailsIsLeftOutAndItsRowsAreMadeByAnother) {
  LUCIOLE_NEEDS_PROGRAM("cc", "gcc");
  const std::string line = "luciole render " + scene("city") + "--shadows hard --hash ";
  const std::string one = succeed(line + "--quiet -o a.exr");
  int in_the_middle = 0;
  for (int number = 1; number <= 61; number += longRun() ? 4 : 12) {
    const Outcome outcome =
        runLine(folder, failingAt(number) + line + "--device all --stats stats.json -o a.exr");
    ASSERT_EQ(outcome.status, 0) << number << "\n" << outcome.err;
    EXPECT_EQ(outcome.out, one) << number;
    const auto stats = nlohmann::json::parse(readText(folder / "stats.json"));
    for (const auto& share : stats.value("devices", nlohmann::json::array()))
      if (share.contains("error")) {
        EXPECT_THAT(outcome.err, ContainsRegex("warning: .*CL_DEVICE_NOT_AVAILABLE; the other devices made"));
        if (share["rows"] > 0) ++in_the_middle;
      }
  }
  EXPECT_GT(in_the_middle, 0);
}

TEST_F(SeveralDevices, WhoseLastOneFailsMakeNoPicture) {
  LUCIOLE_NEEDS_PROGRAM("cc", "gcc");
  const std::string line = "luciole render " + scene("city") + "--shadows hard --quiet --device all ";
  for (const int number : {1, 12})
    refuse("export FAIL_ALL=1; " + failingAt(number) + line + "-o a.exr", 3, "CL_DEVICE_NOT_AVAILABLE");
  EXPECT_FALSE(std::filesystem::exists(folder / "a.exr"));
}

TEST_F(SeveralDevices, MakeFramesOneAfterAnother) {
  writeText(folder / "turning.json",
            R"({"camera": {"eye": [3, 2, 5], "target": [0, 0.5, 0]}, "ambient": 0.1,
  "objects": [{"primitive": "plane", "scale": 20}, {"primitive": "box", "translate": [0, 0.5, 0],
               "keys": [{"frame": 1, "rotate": [0, 0, 0]}, {"frame": 3, "rotate": [0, 40, 0]}]}],
  "lights": [{"type": "point", "position": [2, 3, 2], "shadow": true}]})");
  const std::string line = "luciole render turning.json --size 80x300 --frames 1-3 --hash --quiet ";
  EXPECT_EQ(succeed(two + line + "--device all -o f.#.exr"), succeed(line + "-o f.#.exr"));
}

TEST_F(SeveralDevices, GoWithRenderAlone) {
  writeText(folder / "scene.json", kSmallScene);
  succeed("luciole gbuffer scene.json --quiet -o g.exr");
  refuse("luciole shade g.exr --scene scene.json --device all -o a.exr", 2, "only render takes several");
  refuse("luciole bench --device all", 2, "only render takes several");
  EXPECT_THAT(succeed("luciole render --help"), HasSubstr("or all: each makes some of the rows"));
}

}  // namespace
}  // namespace luciole::test
