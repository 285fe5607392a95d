// render --orbit N: the camera goes once round what it looks at.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include "luciole/image.hpp"
#include "tools/cli/program_test.hpp"

namespace luciole::test {
namespace {

using testing::HasSubstr;

class OrbitOption : public ProgramTest {
 protected:
  /// The most that two pictures differ by.
  double difference(const std::string& a, const std::string& b) {
    const Image first = readImage(folder / a), second = readImage(folder / b);
    EXPECT_EQ(first.pixels.size(), second.pixels.size());
    double most = 0;
    for (std::size_t i = 0; i < first.pixels.size(); ++i)
      most = std::max(most, std::abs(double(first.pixels[i]) - double(second.pixels[i])));
    return most;
  }
};

constexpr const char* kObjects = R"("size": [64, 36], "ambient": 0.3,
  "objects": [{"primitive": "box", "translate": [1, 0.5, 0]}, {"primitive": "cone", "scale": 0.5, "translate": [0, 0, 1]}],
  "lights": [{"type": "directional", "direction": [-1, -2, -0.5]}])";

// Places are rounded otherwise, by some 1e-16 of them, so where no edge of the snapped grid is met the
// pictures are the same but for colours' last bits.
TEST_F(OrbitOption, TurnsAsAnAzimuthThatGrowsBy360DegreesOverN) {
  writeText(folder / "scene.json",
            fmt::format(R"({{"camera": {{"orbit": [10, 20, 6], "target": [0.5, 0, 0]}}, {}}})", kObjects));
  succeed("luciole render scene.json --orbit 8 -o turn#.exr");
  EXPECT_EQ(filesIn(folder).size(), 9u);
  for (int frame = 1; frame <= 8; ++frame) {
    writeText(folder / "still.json",
              fmt::format(R"({{"camera": {{"orbit": [{}, 20, 6], "target": [0.5, 0, 0]}}, {}}})",
                          10 + 45 * (frame - 1), kObjects));
    succeed("luciole render still.json -o still.exr");
    EXPECT_LT(difference(fmt::format("turn{}.exr", frame), "still.exr"), 1e-5) << frame;
  }
  succeed("luciole render scene.json -o plain.exr");
  EXPECT_EQ(difference("turn1.exr", "plain.exr"), 0);
  // Any frame alone, and those of another turn.
  succeed("luciole render scene.json --orbit 8 --frames 3 -o third.exr");
  succeed("luciole render scene.json --orbit 8 --frames 11 -o eleventh.exr");
  EXPECT_EQ(difference("turn3.exr", "third.exr"), 0);
  EXPECT_EQ(difference("turn3.exr", "eleventh.exr"), 0);
}

TEST_F(OrbitOption, TurnsAboutTheCamerasUp) {
  const char* scene = R"({{"camera": {{"eye": [{}], "target": [0, 0, 0], "up": [0, 0, 1]}}, {}}})";
  writeText(folder / "scene.json", fmt::format(fmt::runtime(scene), "6, 0, 2", kObjects));
  writeText(folder / "still.json", fmt::format(fmt::runtime(scene), "0, 6, 2", kObjects));
  succeed("luciole render scene.json --orbit 4 --frames 2 -o a.exr");
  succeed("luciole render still.json -o b.exr");
  EXPECT_LT(difference("a.exr", "b.exr"), 1e-5);
}

// A ball looks the same from everywhere but for its light, and a mesh file's camera looks at its middle.
TEST_F(OrbitOption, ABareMeshStaysInTheMiddle) {
  writeText(folder / "box.obj",
            "v 10 0 0\nv 11 0 0\nv 11 1 0\nv 10 1 0\nv 10 0 -1\nv 11 0 -1\nv 11 1 -1\nv 10 1 -1\n"
            "f 1 2 3 4\nf 6 5 8 7\nf 4 3 7 8\nf 2 6 7 3\nf 5 1 4 8\nf 5 6 2 1\n");
  const std::string told_of = told("luciole render box.obj --size 64x36 --alpha --orbit 4 -o turn#.exr");
  EXPECT_THAT(told_of, HasSubstr("turn4.exr"));
  // Of a cube seen from four sides the silhouette is the same.
  for (int frame = 2; frame <= 4; ++frame) {
    const Image first = readImage(folder / "turn1.exr"),
                turned = readImage(folder / fmt::format("turn{}.exr", frame));
    int differ = 0;
    for (std::size_t i = 3; i < first.pixels.size(); i += 4) differ += first.pixels[i] != turned.pixels[i];
    EXPECT_LE(differ, 4) << frame << ": pixels on edges alone";
  }
}

TEST_F(OrbitOption, AMovingCamerasOwnWayGoesOn) {
  writeText(folder / "scene.json",
            fmt::format(R"({{"camera": {{"orbit": [0, 20, 6], "target": [0, 0, 0], "keys": [
      {{"frame": 1, "orbit": [0, 20, 6]}}, {{"frame": 5, "orbit": [0, 20, 10]}}]}}, {}}})",
                        kObjects));
  writeText(folder / "still.json",
            fmt::format(R"({{"camera": {{"orbit": [90, 20, 7], "target": [0, 0, 0]}}, {}}})", kObjects));
  succeed("luciole render scene.json --orbit 4 -o turn#.exr");
  succeed("luciole render still.json -o still.exr");
  EXPECT_LT(difference("turn2.exr", "still.exr"), 1e-5);
}

TEST_F(OrbitOption, GoesWithASweep) {
  writeText(folder / "scene.json", fmt::format("{{{}}}", kObjects));
  succeed("luciole render scene.json --orbit 8 --frames 3 --sweep ambient=0.3,1 -o s#.exr");
  succeed("luciole render scene.json --orbit 8 --frames 3 -o third.exr");
  EXPECT_EQ(difference("s1.exr", "third.exr"), 0);
}

TEST_F(OrbitOption, WhatCannotBeMeantIsRefused) {
  writeText(folder / "scene.json", fmt::format("{{{}}}", kObjects));
  refuse("luciole render scene.json --orbit 8 -o one.png", 2, "-o one.png: expected a name with ####");
  refuse("luciole render scene.json --orbit 1 -o f#.png", 2, "--orbit");
  refuse("luciole render scene.json --orbit x -o f#.png", 2, "--orbit");
}

TEST_F(OrbitOption, MakesAFilm) {
  LUCIOLE_NEEDS_PROGRAM("ffmpeg", "ffmpeg");
  writeText(folder / "scene.json", fmt::format("{{{}}}", kObjects));
  EXPECT_THAT(told("luciole render scene.json --orbit 6 -o turn.mp4"),
              HasSubstr("turn.mp4: 6 frames of 64x36"));
}

}  // namespace
}  // namespace luciole::test
