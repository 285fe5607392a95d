// --exposure and --tone, as a person would type them.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "image/srgb.hpp"
#include "luciole/image.hpp"
#include "tools/cli/program_test.hpp"

namespace luciole::test {
namespace {

using testing::HasSubstr;
using testing::Not;

/// A light that brightens and a camera that goes round.
constexpr const char* kDawn = R"({
  "camera": {"orbit": [0, 20, 6], "target": [0, 0.5, 0],
             "keys": [{"frame": 1, "orbit": [0, 20, 6]}, {"frame": 9, "orbit": [360, 20, 6]}]},
  "size": [48, 27], "ambient": 0.01,
  "objects": [{"primitive": "plane", "scale": 10}, {"primitive": "box"}],
  "lights": [{"type": "point", "position": [0, 4, 2],
              "keys": [{"frame": 1, "intensity": 0.5}, {"frame": 4, "intensity": 64}]}]
})";

class AutoExposure : public ProgramTest {
 protected:
  AutoExposure() {
    writeText(folder / "scene.json", kSmallScene);
    writeText(folder / "quad.obj", "v -1 -1 0\nv 1 -1 0\nv 1 1 0.5\nv -1 1 0\nf 1 2 3 4\n");
  }

  /// Runs `luciole ARGUMENTS` and returns the stops that it measured; NaN if it measured none, and then it
  /// says nothing of exposure.
  double measured(const std::string& arguments) {
    const Outcome made = run("luciole " + arguments + " --stats stats.json");
    const auto image = nlohmann::json::parse(readText(folder / "stats.json")).at("image");
    if (!image.contains("measured_exposure")) {
      EXPECT_THAT(made.err, Not(HasSubstr("exposure"))) << arguments;
      return NAN;
    }
    const double stops = image["measured_exposure"];
    EXPECT_THAT(made.err, HasSubstr(fmt::format(", exposure {:+.2f} stops, ", stops))) << arguments;
    return stops;
  }

  void expectSame(const std::string& a, const std::string& b) {
    succeed(fmt::format("luciole compare {} {} --max-abs 0", a, b));
  }
};

TEST_F(AutoExposure, IsWhatAMeshFileGetsInAPictureOfIntegers) {
  const double stops = measured("render quad.obj --size 64x36 -o auto.png");
  EXPECT_NE(stops, 0);
  const std::string typed = fmt::format("{:+.2f}", stops);
  EXPECT_EQ(readAttribute(folder / "auto.png", "luciole:exposure"), typed);
  succeed("luciole render quad.obj --size 64x36 --exposure " + typed + " -o typed.png");
  expectSame("auto.png", "typed.png");
  EXPECT_EQ(readAttribute(folder / "typed.png", "luciole:exposure"), "");
  EXPECT_EQ(measured("render quad.obj --size 64x36 --format ppm -o auto"), stops);
}

TEST_F(AutoExposure, IsNothingThatOtherPicturesGetUnasked) {
  for (const char* arguments :
       {"render quad.obj --size 64x36 -o a.exr", "render quad.obj --size 64x36 -o a.tif",
        "render quad.obj --size 64x36 -o a.hdr", "render quad.obj --size 64x36 --exposure 0 -o a.png",
        "render scene.json -o a.png", "gbuffer quad.obj --size 64x36 -o g.exr",
        "shade g.exr --scene quad.obj -o a.exr", "reference quad.obj --size 64x36 -o a.exr"})
    EXPECT_TRUE(std::isnan(measured(arguments))) << arguments;
}

TEST_F(AutoExposure, WhenAskedForIsThatOfTheStopsItTellsForEveryCommandAndFormat) {
  succeed("luciole gbuffer scene.json --quiet -o g.exr");
  for (const std::string line : {"render scene.json", "render scene.json --samples 2 --shading gouraud",
                                 "shade g.exr --scene scene.json", "reference scene.json",
                                 "reference --gbuffer g.exr --scene scene.json"}) {
    const double stops = measured(line + " --exposure auto -o auto.exr");
    EXPECT_GT(std::abs(stops), 0) << line;
    EXPECT_EQ(readAttribute(folder / "auto.exr", "luciole:exposure"), fmt::format("{:+.2f}", stops));
    succeed(fmt::format("luciole {} --exposure {} --quiet -o typed.exr", line, stops));
    expectSame("auto.exr", "typed.exr");
    succeed("rm auto.exr typed.exr");
  }
  // In double precision the same to 1e-5, so that a luminance may fall into the bin beside: 0.0113 stops, and
  // the rounding to hundredths.
  EXPECT_NEAR(measured("render scene.json --shadows off --exposure auto -o a.png"),
              measured("reference scene.json --shadows off --exposure auto -o b.png"), 0.0213);
}

TEST_F(AutoExposure, OfACropIsThatOfTheWholePicture) {
  for (const char* command : {"render", "reference"}) {
    const std::string line = std::string(command) + " scene.json --exposure auto";
    const double stops = measured(line + " -o whole.png");
    EXPECT_EQ(measured(line + " --crop 0,0,96,20 -o part.png"), stops);
    const Image whole = readImage(folder / "whole.png"), part = readImage(folder / "part.png");
    EXPECT_TRUE(std::equal(part.pixels.begin(), part.pixels.end(), whole.pixels.begin())) << command;
  }
  succeed("luciole reference scene.json --exposure auto -o whole.exr");
  succeed("luciole reference scene.json --exposure auto --crop 0,0,96,20 -o parts.exr");
  succeed("luciole reference scene.json --exposure auto --crop 0,20,96,34 -o parts.exr");
  expectSame("whole.exr", "parts.exr");
}

TEST_F(AutoExposure, OfFramesIsThatOfTheFirstForAllAndForEveryShard) {
  writeText(folder / "dawn.json", kDawn);
  const double first = measured("render dawn.json --frames 2 --exposure auto -o 2.exr");
  EXPECT_GT(first - measured("render dawn.json --frames 4 --exposure auto -o 4.exr"), 1)
      << "else nothing brightens";
  succeed("luciole render dawn.json --frames 2-4 --exposure auto --stats '#.json' -o 'f.#.exr'");
  for (const int frame : {2, 3, 4}) {
    succeed(fmt::format("luciole render dawn.json --frames {} --exposure {} -o one.exr", frame, first));
    expectSame(fmt::format("f.{}.exr", frame), "one.exr");
    const auto stats = nlohmann::json::parse(readText(folder / fmt::format("{}.json", frame)));
    EXPECT_EQ(stats["image"]["measured_exposure"], first);
  }
  succeed("luciole render dawn.json --frames 2-4 --exposure auto --shard 2/2 -o 's.#.exr'");
  expectSame("f.3.exr", "s.3.exr");
  succeed("rm f.2.exr && luciole render dawn.json --frames 2-4 --exposure auto --resume -o 'f.#.exr'");
  expectSame("f.2.exr", "2.exr");
}

TEST_F(AutoExposure, OfABlackPictureIsZero) {
  writeText(folder / "night.json", R"({"camera": {"eye": [0, 2, 5], "target": [0, 0, 0]}, "size": [32, 18],
    "objects": [{"primitive": "sphere"}], "lights": [{"type": "point", "position": [0, 9, 0], "intensity": 0}]})");
  EXPECT_EQ(measured("render night.json --exposure auto -o a.png"), 0);
}

TEST_F(AutoExposure, StopsThatAreNoneAreRefused) {
  for (const char* stops : {"bright", "101", "-100.5", "nan", "inf", "1x", "++1", "''"})
    refuse(fmt::format("luciole render scene.json -o a.png --exposure {}", stops), 2, "--exposure");
  refuse("luciole scale scene.json --lights 1 -o out --exposure auto", 2, "--exposure");
}

class Tone : public AutoExposure {};

TEST_F(Tone, FilmicIsTheCurveOfTheExposedLight) {
  succeed("luciole render scene.json --quiet --exposure 1.5 -o linear.exr");
  succeed("luciole render scene.json --quiet --exposure 1.5 --dither off --tone filmic -o filmic.png");
  const Image linear = readImage(folder / "linear.exr"), filmic = readImage(folder / "filmic.png");
  ASSERT_EQ(linear.pixels.size(), filmic.pixels.size());
  for (std::size_t i = 0; i < linear.pixels.size(); ++i) {
    const double x = linear.pixels[i];
    const double y = std::clamp((x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14), 0.0, 1.0);
    // Half a step of rounding, and what a 16-bit code and its decoding leave of a code: below 1e-3.
    ASSERT_NEAR(255 * encodeSrgb(filmic.pixels[i]), 255 * encodeSrgb(float(y)), 0.501) << i;
  }
  succeed("luciole gbuffer scene.json --quiet -o g.exr");
  succeed("luciole shade g.exr --scene scene.json --exposure 1.5 --dither off --tone filmic -o shaded.png");
  expectSame("filmic.png", "shaded.png");
}

TEST_F(Tone, ClipIsWhatHappensWithoutTheOption) {
  succeed(
      "luciole render scene.json --quiet -o a.png && luciole render scene.json --quiet --tone clip -o b.png");
  expectSame("a.png", "b.png");
  succeed("luciole render scene.json --quiet --tone filmic -o c.png");
  EXPECT_EQ(runLine(folder, "luciole compare a.png c.png --max-abs 0.01").status, 1);
}

TEST_F(Tone, FloatsTakeNone) {
  for (const char* name : {"out.exr", "out.hdr", "out.tif"})
    refuse(fmt::format("luciole render scene.json --tone filmic -o {}", name), 2,
           fmt::format("--tone filmic: {} holds light as it is", name));
  refuse("luciole render scene.json --tone film -o out.png", 2, "--tone");
  EXPECT_FALSE(std::filesystem::exists(folder / "out.exr"));
}

}  // namespace
}  // namespace luciole::test
