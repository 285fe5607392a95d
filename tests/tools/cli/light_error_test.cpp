// --light-error as a person would type it.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>

#include "luciole/image.hpp"
#include "tools/cli/program_test.hpp"

namespace luciole::test {
namespace {

using ::testing::HasSubstr;

// As few lights and pixels as clusters still pay for at errors that floats can't promise: for that a picture
// must have enough pixels, and each of them be narrow.
constexpr int kManyLightsCount = 20'000;
constexpr const char* kManyLights = R"({"size": [128, 72],
  "camera": {"eye": [0, 3, 5], "target": [0, 0, 0], "fov_y": 6, "keys": [{"frame": 1, "eye": [0, 3, 5]}, {"frame": 3, "eye": [2, 3, 4]}]},
  "objects": [{"primitive": "plane", "scale": 4}],
  "light_fields": [{"count": 20000, "min": [-4, 0.1, -4], "max": [4, 3, 4], "no_range": true}]})";

class LightError : public ProgramTest {
 protected:
  LightError() {
    std::string lights;
    for (int row = 0; row < 50; ++row)
      for (int column = 0; column < 50; ++column)
        lights += fmt::format(
            R"({{"type": "point", "position": [{}, 1, {}], "intensity": 0.001, "attenuation": [0, 0, 1]}},)",
            0.1 * column - 2.5, 0.1 * row - 2.5);
    writeText(folder / "scene.json",
              R"({"size": [160, 90], "camera": {"eye": [0, 3, 5], "target": [0, 0, 0], "fov_y": 8},
      "objects": [{"primitive": "plane", "scale": 4}], "lights": [)" +
                  lights +
                  R"({"type": "spot", "position": [0, 9, 0], "direction": [0, -1, 0], "cutoff": 80}]})");
  }

  /// For how many lights clusters stand in the picture of stats.json.
  int standIns() const {
    return nlohmann::json::parse(readText(folder / "stats.json"))["counts"]["lights_stood_for"];
  }
};

TEST_F(LightError, WithoutOrOfZeroIsTheSamePicture) {
  succeed("luciole render scene.json --quiet -o usual.exr");
  for (const std::string zero : {"0", "0/256", "0.0"})
    succeed("luciole render scene.json --quiet --light-error " + zero +
            " -o zero.exr && luciole compare usual.exr zero.exr --max-abs 0");
}

TEST_F(LightError, ANumberAndAFractionAreTheSame) {
  succeed("luciole render scene.json --quiet --light-error 1/256 -o a.exr");
  succeed("luciole render scene.json --quiet --light-error 0.00390625 -o b.exr");
  succeed("luciole compare a.exr b.exr --max-abs 0");
}

TEST_F(LightError, WhatIsNoShareIsRefused) {
  for (const std::string wrong :
       {"-0.1", "1.5", "nan", "inf", "1/0", "1/", "/2", "a", "1/256x", "3/2", "1/-2", "''"})
    refuse("luciole render scene.json -o out.png --light-error " + wrong, 2, "--light-error");
}

TEST_F(LightError, LayerAndStatsTellTheBoundOfPicturesAndGBuffers) {
  succeed("luciole gbuffer scene.json --quiet -o g.exr");
  for (const std::string command : {"render scene.json", "shade g.exr --scene scene.json"}) {
    succeed("luciole " + command +
            " --quiet --light-error 1/64 --aov light_error -o out.exr --stats stats.json");
    const Image image = readImage(folder / "out.exr");
    for (const char* name : {"light_error.R", "light_error.G", "light_error.B"})
      EXPECT_NE(std::find(image.channels.begin(), image.channels.end(), name), image.channels.end()) << name;
    const auto stats = nlohmann::json::parse(readText(folder / "stats.json"));
    EXPECT_EQ(stats["counts"]["lights_stood_for"], 2500);
    EXPECT_EQ(stats["counts"]["lights_exact"], 1);
    EXPECT_EQ(stats["counts"]["lights_exact_by_kind"], 1);
    for (const char* count :
         {"pixels_redone", "pixel_clusters_evaluated", "pixel_clustered_lights_evaluated"})
      EXPECT_TRUE(stats["counts"].contains(count)) << count;
    EXPECT_GT(stats["light_error"]["largest"], 0);
    EXPECT_LE(stats["light_error"]["mean"], stats["light_error"]["largest"]);
  }
}

TEST_F(LightError, LessThanFloatsCanPromiseIsToldInOneLine) {
  const Outcome met = run("luciole render scene.json --light-error 1/1024 -o out.exr --stats stats.json");
  EXPECT_EQ(met.status, 0) << met.err;
  EXPECT_THAT(met.err, Not(HasSubstr("warning")));
  EXPECT_EQ(standIns(), 2500);
  writeText(folder / "many.json", kManyLights);
  const Outcome outcome = run("luciole render many.json --light-error 1e-5 -o out.exr --stats stats.json");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("warning: --light-error 1e-05: floats can't promise it"));
  const auto stats = nlohmann::json::parse(readText(folder / "stats.json"));
  EXPECT_GT(stats["light_error"]["least_allowing"], 1e-5);
  EXPECT_LT(stats["light_error"]["least_allowing"], 1e-3);
  EXPECT_EQ(stats["warnings"].size(), 1u);
}

TEST_F(LightError, TheLeastThatFloatsCanPromiseIsPromised) {
  writeText(folder / "many.json", kManyLights);
  const std::string render = "luciole render many.json --quiet -o out.exr --stats stats.json --light-error ";
  succeed(render + "1e-5");
  const auto told = nlohmann::json::parse(readText(folder / "stats.json"));
  const std::string warning = told["warnings"].at(0), before = "the least that they can is ";
  ASSERT_THAT(warning, HasSubstr(before));
  const std::string least = warning.substr(warning.find(before) + before.size());
  succeed(render + least);
  const auto kept = nlohmann::json::parse(readText(folder / "stats.json"));
  EXPECT_EQ(kept["warnings"].size(), 0u) << kept["warnings"];
  EXPECT_LE(kept["light_error"]["least_allowing"], 1.000001 * std::stod(least));
  succeed(render + fmt::format("{}", 0.9 * std::stod(least)));
  const auto missed = nlohmann::json::parse(readText(folder / "stats.json"));
  EXPECT_EQ(missed["warnings"].size(), 1u) << "less can be promised than the least";
}

TEST_F(LightError, ChangesNoBitWithThreadsLanesOrTiles) {
  writeText(folder / "many.json", kManyLights);
  const std::string render =
      "luciole render many.json --quiet --size 150x100 --samples 4 --light-error 1/256 --aov light_error ";
  succeed(render + "-o usual.exr --stats stats.json");
  EXPECT_EQ(standIns(), kManyLightsCount);
  for (const char* other : {"--threads 1", "--threads 2", "--threads 3", "--device ,lanes=1",
                            "--device ,lanes=4", "--device ,lanes=8", "--tile 16", "--culling none"})
    succeed(render + other + " -o other.exr && luciole compare usual.exr other.exr --max-abs 0");
}

TEST_F(LightError, FramesAndTheirShardsArePicturesRenderedAlone) {
  writeText(folder / "many.json", kManyLights);
  const std::string render = "luciole render many.json --quiet --light-error 1/256 --aov light_error ";
  succeed(render + "--frames 1 -o one.exr --stats stats.json");
  EXPECT_EQ(standIns(), kManyLightsCount);
  succeed(render + "--frames 1-3 -o all.#.exr");
  succeed(render + "--frames 1-3 --shard 1/2 -o part.#.exr");
  succeed(render + "--frames 1-3 --shard 2/2 -o part.#.exr");
  for (const int frame : {1, 2, 3}) {
    succeed(render + fmt::format("--frames {} -o alone.exr", frame));
    for (const char* name : {"all", "part"})
      succeed(fmt::format("luciole compare {}.{}.exr alone.exr --max-abs 0", name, frame));
  }
  EXPECT_EQ(runLine(folder, "luciole compare all.1.exr all.2.exr --max-abs 0").status, 1) << "nothing moves";
}

TEST_F(LightError, LightsThatTakeLightAwayAreRefused) {
  for (const char* light : {R"("color": [1, -0.1, 1])", R"("intensity": -1)", R"("attenuation": [0, 0, -1])",
                            R"("diffuse": -1)", R"("attenuation": [0, 0, 0])"}) {
    writeText(folder / "dark.json", fmt::format(R"({{"camera": {{"eye": [0, 3, 5], "target": [0, 0, 0]}},
                "objects": [{{"primitive": "plane"}}],
                "lights": [{{"type": "point", "position": [0, 1, 0], "attenuation": [0, 0, 1], {}}}]}})",
                                                light));
    refuse("luciole render dark.json -o out.png --light-error 1/64", 2, "lights[0]");
  }
}

TEST_F(LightError, InfoSaysForWhichLightsClustersMayStand) {
  EXPECT_THAT(succeed("luciole info scene.json"),
              HasSubstr("clusters may stand for 2500 (--light-error), 0 may be sampled; not: 1 by kind"));
  const auto lights = nlohmann::json::parse(succeed("luciole info scene.json --json -"))["lights"];
  EXPECT_EQ(lights["clusterable"], 2500);
  EXPECT_EQ(lights["exact"]["kind"], 1);
}

TEST_F(LightError, InfoSaysWhatAPictureWouldDo) {
  EXPECT_THAT(succeed("luciole info scene.json --light-error 1/64"), HasSubstr(" clusters stand for 2500\n"));
  EXPECT_THAT(succeed("luciole info scene.json --light-error 1/64 --size 4x4"),
              HasSubstr(" 2500 are too few for it\n"));
  writeText(folder / "many.json", kManyLights);
  const std::string sampled = "luciole info many.json --cast-shadows all --light-error 1/64 --confidence 0.9";
  EXPECT_THAT(succeed(sampled), HasSubstr(" 20000 are sampled by about "));
  const auto lights = nlohmann::json::parse(succeed(sampled + " --json -"))["lights"];
  EXPECT_EQ(lights["clustered"], 0);
  EXPECT_EQ(lights["sampled"], 20000);
  EXPECT_EQ(lights["confidence"], 0.9);
  EXPECT_GT(lights["rays_per_point"], 0);
}

}  // namespace
}  // namespace luciole::test
