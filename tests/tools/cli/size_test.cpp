// --size: in both directions, or as wide as said and of the scene's own shape.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>
#include <tuple>

#include "luciole/image.hpp"
#include "tools/cli/run_program.hpp"

namespace luciole::test {
namespace {

class Size : public testing::Test {
 protected:
  void writeScene(const std::string& size) {
    writeText(folder / "scene.json", R"({"camera": {"eye": [0, 0, 3], "target": [0, 0, 0]}, )" + size +
                                         R"("objects": [{"primitive": "box"}], "lights": [], "ambient": 1})");
  }
  TemporaryFolder folder;
};

TEST_F(Size, WidthAloneKeepsTheScenesShape) {
  for (const auto& [scene, typed, width, height] : {std::tuple{"\"size\": [96, 54], ", "48", 48, 27},
                                                    {"\"size\": [96, 54], ", "50", 50, 28},  // of 28.125
                                                    {"\"size\": [30, 90], ", "7", 7, 21},
                                                    {"\"size\": [1000, 1], ", "20", 20, 1},
                                                    {"", "64", 64, 36}}) {
    writeScene(scene);
    const Outcome outcome =
        runLine(folder, fmt::format("luciole gbuffer scene.json --size {} -o a.exr", typed));
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const Image image = readImage(folder / "a.exr");
    EXPECT_EQ(image.width, width) << typed;
    EXPECT_EQ(image.height, height) << typed;
  }
}

TEST_F(Size, WhatIsNoSizeIsRefusedInOneLine) {
  writeScene("");
  for (const char* typed :
       {"0", "65537", "2147483647", "99999999999", "x300", "400x", "400x300x2", "4e2", "0x0"}) {
    const Outcome outcome =
        runLine(folder, fmt::format("luciole gbuffer scene.json --size {} -o a.exr", typed));
    EXPECT_EQ(outcome.status, 2) << typed;
    EXPECT_TRUE(isOneLine(outcome.err)) << outcome.err;
    EXPECT_NE(outcome.err.find("--size"), std::string::npos) << outcome.err;
  }
  writeScene("\"size\": [1, 32768], ");
  const Outcome tall = runLine(folder, "luciole gbuffer scene.json --size 32768 -o a.exr");
  EXPECT_EQ(tall.status, 2);
  EXPECT_NE(tall.err.find("--size: 32768x1073741824 pixels"), std::string::npos) << tall.err;
}

}  // namespace
}  // namespace luciole::test
