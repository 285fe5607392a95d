// --confidence, --seed and --light-error-relative as a person would type them.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "tools/cli/program_test.hpp"

namespace luciole::test {
namespace {

using ::testing::HasSubstr;

/// Few pixels and many lights that cast shadows, of which enough are hidden that they differ.
constexpr int kRows = 60;

class LightConfidenceOptions : public ProgramTest {
 protected:
  LightConfidenceOptions() {
    std::string lights;
    for (int i = 0; i < kRows * kRows; ++i)
      lights += fmt::format(
          R"({}{{"type": "point", "position": [{}, {}, {}], "intensity": 0.001, "attenuation": [0, 0, 1], "shadow": true}})",
          i > 0 ? "," : "", 0.08 * (i % kRows) - 2.4, 0.5 + 0.1 * (i % 7), 0.08 * (i / kRows) - 2.4);
    writeText(folder / "scene.json", R"({"size": [24, 16],
      "camera": {"eye": [0, 1, 3], "target": [0, 0.3, 0], "fov_y": 40},
      "objects": [{"primitive": "plane", "scale": 4},
                  {"primitive": "torus", "translate": [0, 0.4, 0], "scale": 0.5}], "lights": [)" +
                                         lights + "]}");
  }

  nlohmann::json stats() const { return nlohmann::json::parse(readText(folder / "stats.json")); }
};

TEST_F(LightConfidenceOptions, WhatIsNoConfidenceIsRefused) {
  const std::string render = "luciole render scene.json -o out.png --light-error 1/16 ";
  for (const std::string wrong : {"0.49", "1", "0", "-1", "99", "nan", "a", "''"})
    refuse(render + "--confidence " + wrong, 2, "--confidence");
  for (const std::string wrong : {"-1", "4294967296", "0.5", "a"})
    refuse(render + "--seed " + wrong, 2, "--seed");
  for (const std::string wrong : {"-0.1", "1.5", "nan", "1/0", "a"})
    refuse("luciole render scene.json -o out.png --light-error-relative " + wrong, 2,
           "--light-error-relative");
  refuse(render + "--light-error-relative 1/16", 2, "--light-error");
}

TEST_F(LightConfidenceOptions, ChangeRaysPictureAndWhatStatsSay) {
  const std::string render =
      "luciole render scene.json --quiet --stats stats.json --aov light_error,light_proof ";
  succeed(render + "--light-error 1/8 -o usual.exr");
  const nlohmann::json usual = stats();
  EXPECT_EQ(usual["counts"]["lights_sampled"], kRows * kRows);
  for (const char* count : {"sampled_rays", "sampled_groups", "sampled_strata", "sampled_rounds"})
    EXPECT_GT(usual["counts"][count], 0) << count;
  EXPECT_EQ(usual["counts"]["pixels_beyond_light_error"], 0);
  EXPECT_GT(usual["light_error"]["largest"], usual["light_error"]["mean"]);
  succeed(render + "--light-error 1/8 --seed 0 --confidence 0.99 --threads 1 -o same.exr");
  expectSamePicture("usual.exr", "same.exr");
  for (const char* other :
       {"--light-error 1/8 --seed 7", "--light-error 1/8 --confidence 0.6", "--light-error-relative 1/8"}) {
    succeed(render + other + " -o other.exr");
    EXPECT_EQ(stats()["counts"]["lights_sampled"], kRows * kRows) << other;
    EXPECT_EQ(runLine(folder, "luciole compare usual.exr other.exr --max-abs 0").status, 1) << other;
  }
}

TEST_F(LightConfidenceOptions, ThreadsChangeNoBit) {
  const std::string render = "luciole render scene.json --quiet --light-error 1/8 --size 60x40 ";
  succeed(render + "-o two.npy --threads 2");
  succeed(render + "-o one.npy --threads 1");
  EXPECT_EQ(readText(folder / "one.npy"), readText(folder / "two.npy"));
}

// Noise is of a pixel's place in the picture, so it doesn't crawl.
TEST_F(LightConfidenceOptions, FramesAtRestAreTheSamePicture) {
  succeed("luciole render scene.json --quiet --light-error 1/8 --frames 1-2 -o frame.#.exr");
  expectSamePicture("frame.1.exr", "frame.2.exr");
}

// More lights than there are strata, of which a grid hides many.
TEST_F(LightConfidenceOptions, PixelsThatStayBeyondTheirErrorAreToldInOneLine) {
  std::string lights;
  for (int i = 0; i < 30'000; ++i)
    lights += fmt::format(
        R"({}{{"type": "point", "position": [{}, {}, {}], "intensity": 0.001, "attenuation": [0, 0, 1], "shadow": true}})",
        i > 0 ? "," : "", 0.03 * (i % 173) - 2.5, 0.5 + 0.1 * (i % 13), 0.03 * (i / 173) - 2.5);
  writeText(folder / "many.json", R"({"size": [4, 4],
      "camera": {"eye": [0, 0.5, 0.5], "target": [0, 0, 0], "fov_y": 2},
      "objects": [{"primitive": "plane", "scale": 4}, {"primitive": "torus", "translate": [0, 0.7, 0], "scale": 0.3},
                  {"primitive": "torus", "translate": [0.2, 1, 0.1], "scale": 0.3}], "lights": [)" +
                                      lights + "]}");
  const std::string render = "luciole render many.json --shadows exact -o out.exr --stats stats.json ";
  const Outcome outcome = run(render + "--light-error 1/3500 --confidence 0.9");
  EXPECT_EQ(stats()["counts"]["lights_sampled"], 30'000);
  EXPECT_EQ(stats()["counts"]["pixels_beyond_light_error"], 16);
  EXPECT_THAT(outcome.err, HasSubstr("16 pixels stayed beyond it at a confidence of 0.9"));
  EXPECT_EQ(stats()["warnings"].size(), 1u) << stats()["warnings"];
  EXPECT_THAT(told(render + "--light-error 1/16"), Not(HasSubstr("warning")));
}

TEST_F(LightConfidenceOptions, InfoSaysWhichLightsMayBeSampled) {
  EXPECT_THAT(
      succeed("luciole info scene.json --shadows exact"),
      HasSubstr(fmt::format("clusters may stand for 0 (--light-error), {} may be sampled", kRows * kRows)));
  const auto lights =
      nlohmann::json::parse(succeed("luciole info scene.json --shadows exact --json -"))["lights"];
  EXPECT_EQ(lights["sampleable"], kRows * kRows);
}

}  // namespace
}  // namespace luciole::test
