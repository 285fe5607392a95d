// The program as a person types it: every command, its output files, its exit status.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "luciole/compare.hpp"
#include "luciole/image.hpp"
#include "tools/cli/program_test.hpp"

namespace luciole::test {
namespace {

class CommandLine : public ProgramTest {
 protected:
  CommandLine() { writeText(folder / "scene.json", kSmallScene); }

  /// The same, and that no file was made.
  void refuse(const std::string& line, int status, const std::string& what) {
    ProgramTest::refuse(line, status, what);
    EXPECT_EQ(fileCount("out"), 0) << line;
  }

  /// Files whose name holds `part`; hidden ones too, so leftovers of a failed write are seen.
  int fileCount(const std::string& part) {
    int count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
      const std::string name = entry.path().filename().string();
      count += name.find(part) != std::string::npos || name[0] == '.';
    }
    return count;
  }
};

TEST_F(CommandLine, RenderWritesAPictureOfTheScenesSize) {
  succeed("luciole render scene.json -o out.png");
  const Image image = readImage(folder / "out.png");
  EXPECT_EQ(image.width, 96);
  EXPECT_EQ(image.height, 54);
}

TEST_F(CommandLine, SizeOptionWinsOverTheScene) {
  for (const auto& [width, height] : {std::pair{1, 1}, {7, 93}, {144, 17}}) {
    succeed("luciole render scene.json --quiet -o out.npy --size " + std::to_string(width) + "x" +
            std::to_string(height));
    const Image image = readImage(folder / "out.npy");
    EXPECT_EQ(image.width, width);
    EXPECT_EQ(image.height, height);
  }
}

TEST_F(CommandLine, CullingNeverChangesThePicture) {
  succeed("luciole render scene.json --culling none -o none.npy");
  for (const char* tile : {"4", "8", "16"})
    succeed(fmt::format(
        "luciole render scene.json --tile {} -o a.npy && luciole compare a.npy none.npy --max-abs 0", tile));
  EXPECT_EQ(runLine(folder, "luciole render scene.json --tile 5 -o b.npy").status, 2);
}

TEST_F(CommandLine, ADeviceOfSmallWorkGroupsMakesTheSamePicture) {
  // A lane a pixel wants groups of 256, PoCL takes 4096 unless it is told to take fewer.
  for (const char* lanes : {"1", "4", "16"}) {
    const std::string render =
        fmt::format("render scene.json --device ,lanes={} --stats stats.json -o ", lanes);
    succeed("luciole " + render + "usual.npy");
    for (const char* most : {"64", "1"})
      succeed(fmt::format("POCL_MAX_WORK_GROUP_SIZE={} '" LUCIOLE_BINARY
                          "' {} small.npy && luciole compare usual.npy small.npy --max-abs 0",
                          most, render));
  }
}

TEST_F(CommandLine, ShadingAGBufferFileEqualsRenderingBitForBit) {
  for (const char* options : {"", "--shading flat"}) {
    const std::string o = options;
    succeed("luciole render scene.json -o a.npy " + o);
    succeed("luciole gbuffer scene.json -o g.exr " + o +
            " && luciole shade g.exr --scene scene.json -o b.npy");
    succeed("luciole compare a.npy b.npy --max-abs 0");
  }
}

TEST_F(CommandLine, ShadingAGBufferFileEqualsRenderingBitForBitWithShadowsOnCoarseSmoothMeshes) {
  // Shadows go by the triangles' own normals, which differ most from the shading normals there.
  test::writeText(folder / "coarse.json", R"({
    "camera": {"eye": [1.1, 2.3, 4.7], "target": [0.1, 0.4, 0.2]}, "size": [97, 61], "ambient": 0.1,
    "objects": [{"primitive": "plane", "scale": 5},
                {"primitive": "sphere", "segments": 9, "translate": [0.2, 0.8, 0], "rotate": [13, 31, 7]}],
    "lights": [{"type": "directional", "direction": [-1, -0.7, 0.3], "shadow": true},
               {"type": "point", "position": [-2, 3, 1], "intensity": 4, "radius": 0.3, "shadow": true},
               {"type": "spot", "position": [3, 4, 2], "direction": [-3, -4, -2], "cutoff": 30, "shadow": true}]})");
  for (const char* options : {"--shadows hard", "--shadows pcf", "--shadows soft-exact --soft-samples 5"}) {
    const std::string o = options;
    succeed("luciole render coarse.json -o a.npy " + o);
    succeed("luciole gbuffer coarse.json -o g.exr && luciole shade g.exr --scene coarse.json -o b.npy " + o);
    succeed("luciole compare a.npy b.npy --max-abs 0");
  }
}

TEST_F(CommandLine, GouraudGBufferShadesToTheGouraudPicture) {
  succeed("luciole render scene.json --shading gouraud -o a.npy");
  succeed(
      "luciole gbuffer scene.json --shading gouraud -o g.exr && luciole shade g.exr --scene scene.json -o "
      "b.npy");
  succeed("luciole compare a.npy b.npy --max-abs 0");
}

TEST_F(CommandLine, CropIsACutOutOfTheWholePicture) {
  succeed(
      "luciole render scene.json --samples 2 -o whole.npy && luciole render scene.json --samples 2 --crop "
      "33,7,20,31 -o part.npy");
  const Image whole = readImage(folder / "whole.npy"), part = readImage(folder / "part.npy");
  ASSERT_EQ(part.width, 20);
  ASSERT_EQ(part.height, 31);
  for (int y = 0; y < part.height; ++y)
    for (int i = 0; i < 3 * part.width; ++i)
      ASSERT_EQ(part.pixels[y * 3 * part.width + i], whole.pixels[(y + 7) * 3 * whole.width + 3 * 33 + i]);
}

TEST_F(CommandLine, SamplesOfALightAreOneTo1024) {
  for (const char* samples : {"0", "1025", "-1", "1.5"}) {
    const Outcome outcome =
        runLine(folder, fmt::format("luciole render scene.json --soft-samples {} -o a.exr", samples));
    EXPECT_EQ(outcome.status, 2) << samples;
    EXPECT_TRUE(isOneLine(outcome.err)) << outcome.err;
    EXPECT_NE(outcome.err.find("--soft-samples"), std::string::npos) << outcome.err;
  }
  for (const char* samples : {"1", "1024"})
    succeed(
        fmt::format("luciole render scene.json --shadows soft-exact --soft-samples {} -o a.exr", samples));
}

TEST_F(CommandLine, FlatGouraudAndPhongDiffer) {
  for (const char* shading : {"flat", "gouraud", "phong"})
    succeed(std::string("luciole render scene.json --shading ") + shading + " -o " + shading + ".npy");
  EXPECT_EQ(runLine(folder, "luciole compare flat.npy phong.npy --max-abs 0.01").status, 1);
  EXPECT_EQ(runLine(folder, "luciole compare gouraud.npy phong.npy --max-abs 0.01").status, 1);
}

TEST_F(CommandLine, EveryModelMakesAnotherPictureThanPhongs) {
  succeed("luciole render scene.json -o usual.npy && luciole render scene.json --model phong -o phong.npy");
  EXPECT_EQ(runLine(folder, "luciole compare usual.npy phong.npy --max-abs 0").status, 0);
  for (const std::string model : {"blinn-phong", "toon", "cook-torrance", "ward"}) {
    succeed("luciole render scene.json --model " + model + " -o other.npy");
    EXPECT_EQ(runLine(folder, "luciole compare usual.npy other.npy --max-abs 0.01").status, 1) << model;
  }
}

TEST_F(CommandLine, ExposureIsInStops) {
  succeed("luciole render scene.json -o a.npy && luciole render scene.json --exposure 1 -o b.npy");
  const Image a = readImage(folder / "a.npy"), b = readImage(folder / "b.npy");
  for (std::size_t i = 0; i < a.pixels.size(); ++i) ASSERT_EQ(2 * a.pixels[i], b.pixels[i]);
}

TEST_F(CommandLine, AovsBecomeLayers) {
  succeed(
      "luciole render scene.json --aov position,normal,depth,diffuse,material,light_count,list_length,shadow,"
      "shading_count "
      "-o out.exr");
  const Image image = readImage(folder / "out.exr");
  for (const char* name :
       {"R", "G", "B", "P.X", "P.Y", "P.Z", "N.X", "N.Y", "N.Z", "Z", "diffuse.R", "specular.G", "shininess",
        "ambient.B", "emission.R", "light_count", "list_length", "shadow", "shading_count"})
    EXPECT_NE(std::find(image.channels.begin(), image.channels.end(), name), image.channels.end()) << name;
}

TEST_F(CommandLine, AovsNeedAFormatWithLayers) {
  refuse("luciole render scene.json --aov normal,depth -o out.png", 2, "--aov");
}

TEST_F(CommandLine, StatsNameEveryStageAndCount) {
  succeed("luciole render scene.json -o out.png --stats stats.json");
  const auto stats = nlohmann::json::parse(readText(folder / "stats.json"));
  for (const char* key : {"version", "command", "device", "scene", "image", "stages", "counts", "memory",
                          "cold_start_milliseconds"})
    EXPECT_TRUE(stats.contains(key)) << key;
  const auto& counts = stats["counts"];
  EXPECT_EQ(stats["scene"]["lights"], 203);
  EXPECT_EQ(stats["image"]["width"], 96);
  EXPECT_GT(counts["pixels_lit"], 0);
  EXPECT_GE(counts["pixel_lights_evaluated"], counts["pixel_lights_in_range"]);
  // Two lights reach everywhere, so at least these are in range of every lit pixel.
  EXPECT_GE(counts["pixel_lights_in_range"], 2 * counts["pixels_lit"].get<int>());
  EXPECT_GT(counts["list_entries"], 0);
  EXPECT_GT(stats["memory"]["peak_bytes"], 0);
}

TEST_F(CommandLine, StatsAreALineOfATableWhoseColumnsAreTheSameForAllRuns) {
  succeed("luciole render scene.json -o out.png --stats a.csv");
  succeed("luciole gbuffer scene.json -o g.exr --stats b.csv");
  const std::string a = readText(folder / "a.csv"), b = readText(folder / "b.csv");
  EXPECT_EQ(std::count(a.begin(), a.end(), '\n'), 2);
  EXPECT_EQ(a.substr(0, a.find('\n')), b.substr(0, b.find('\n')));
  for (const char* name :
       {"version,command,", ",lights,width,height,samples,", ",picture_ms,", ",shade_ms,", ",pixels_lit,"})
    EXPECT_NE(a.find(name), std::string::npos) << name;
  EXPECT_NE(a.find(",203,96,54,1,"), std::string::npos) << a;
}

/// What the line about a finished picture says of time: "… lights, 123 ms (load scene 4, shade 56)".
struct PrintedTime {
  double picture = -1, stages = 0;
};

PrintedTime printedTime(const std::string& line) {
  PrintedTime time;
  const std::size_t unit = line.find(" ms");
  if (unit == std::string::npos) return time;
  time.picture = std::stod(line.substr(line.rfind(", ", unit) + 2));
  std::string stages = line.substr(unit + 3);
  std::replace_if(
      stages.begin(), stages.end(), [](char c) { return c == ',' || c == ')'; }, ' ');
  std::istringstream words(stages);
  for (std::string word; words >> word;)
    if (std::isdigit(static_cast<unsigned char>(word[0]))) time.stages += std::stod(word);
  return time;
}

TEST_F(CommandLine, PrintedTimeIsTheClocksAndNoLessThanItsStagesShares) {
  // Kernels are compiled in a thread of their own, and the cache has none of these: that takes most of the
  // time.
  for (const std::string options :
       {"--shadows off --culling none", "--shadows off --culling none --shading gouraud --samples 2"}) {
    const auto start = std::chrono::steady_clock::now();
    const Outcome outcome =
        runLine(folder, "POCL_CACHE_DIR=cache" + std::to_string(options.size()) +
                            " '" LUCIOLE_BINARY "' render scene.json -o a.png --stats stats.json " + options);
    const std::chrono::duration<double, std::milli> passed = std::chrono::steady_clock::now() - start;
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const PrintedTime time = printedTime(outcome.err);
    EXPECT_GT(time.stages, 0) << outcome.err;
    EXPECT_LE(time.stages, time.picture) << outcome.err;
    EXPECT_LE(time.picture, passed.count()) << outcome.err;

    const auto stats = nlohmann::json::parse(readText(folder / "stats.json"));
    double shares = 0, all = 0;
    for (const auto& stage : stats["stages"]) {
      EXPECT_TRUE(stage["name"].is_string());
      EXPECT_LE(stage["wall_milliseconds"], stage["milliseconds"]);
      shares += stage["wall_milliseconds"].get<double>();
      all += stage["milliseconds"].get<double>();
    }
    EXPECT_LE(shares, stats["picture_milliseconds"]);
    EXPECT_LT(shares, all) << "compiling, which ran beside others, is a stage as well";
    EXPECT_EQ(time.picture, std::floor(stats["picture_milliseconds"].get<double>())) << outcome.err;
    EXPECT_EQ(stats["picture_milliseconds"], stats["wall_milliseconds"]) << "the first picture's";
    EXPECT_LE(stats["wall_milliseconds"], passed.count());
  }
}

TEST_F(CommandLine, ObjectsBehindTheFogAreCountedAndLeftOut) {
  writeText(
      folder / "fog.json",
      R"({"camera": {"eye": [0, 1, 5], "target": [0, 1, 0]}, "size": [64, 36], "background": [0.5, 0.5, 0.5],
    "fog": {"mode": "exp", "density": 1, "color": [0.5, 0.5, 0.5]}, "lights": [{"type": "directional", "direction": [0, -1, -1]}],
    "objects": [{"primitive": "sphere"}, {"primitive": "sphere", "translate": [3, 0, -50]}]})");
  succeed("luciole render fog.json -o out.png --stats stats.json");
  EXPECT_EQ(nlohmann::json::parse(readText(folder / "stats.json"))["counts"]["objects_hidden_by_fog"], 1);
}

TEST_F(CommandLine, PicturesSayHowTheyWereMade) {
  succeed("luciole render scene.json -o out.exr");
  const std::string bytes = readText(folder / "out.exr");
  EXPECT_NE(bytes.find("Luciole"), std::string::npos);
  EXPECT_NE(bytes.find("luciole render scene.json -o out.exr"), std::string::npos);
}

TEST_F(CommandLine, StandardInputAndOutputStandForFiles) {
  succeed(
      "cat scene.json | luciole render - --quiet -o - > piped.png && luciole render scene.json --quiet -o "
      "file.png");
  expectSamePicture("piped.png", "file.png");
}

TEST_F(CommandLine, CompareReportsFiguresAndFailsOverTheLimit) {
  succeed("luciole render scene.json -o a.png && luciole render scene.json --exposure 1 -o b.png");
  const Outcome outcome =
      runLine(folder, "luciole compare a.png b.png --max-abs 0.001 --diff d.png --error-map e.png --json -");
  EXPECT_EQ(outcome.status, 1);
  const auto json = nlohmann::json::parse(outcome.out);
  for (const char* key : {"channels", "pixels", "max_abs", "mean_abs", "max_relative", "mean_relative",
                          "mean_signed", "mse", "rmse", "psnr", "relmse", "mape", "smape", "p99_abs",
                          "p999_abs", "nonfinite", "pixels_over", "worst_pixel"})
    EXPECT_TRUE(json.contains(key)) << key;
  EXPECT_GT(json["mean_signed"], 0);
  EXPECT_EQ(json["pixels"], 96 * 54);
  EXPECT_EQ(readImage(folder / "d.png").width, 96);
  EXPECT_GE(readImage(folder / "e.png").width, 96);
  const std::string text = succeed("luciole compare a.png b.png");
  for (const char* figure :
       {"5184 of 5184 pixels", "max_abs", "mean_abs", "max_relative", "mean_relative", "mean_signed", "mse",
        "rmse", "psnr", "relmse", "mape", "smape", "p99_abs", "p999_abs", "nonfinite"})
    EXPECT_NE(text.find(figure), std::string::npos) << figure;
}

TEST_F(CommandLine, CompareLooksAtSampledPixelsAlone) {
  writeImage({2, 1, {"R", "G", "B", "sampled"}, {0, 0, 0, 0, 0.5f, 0.5f, 0.5f, 1}}, folder / "sparse.exr",
             {});
  writeImage({2, 1, {"R", "G", "B"}, {9, 9, 9, 0.5f, 0.5f, 0.625f}}, folder / "full.exr", {});
  const auto json =
      nlohmann::json::parse(succeed("luciole compare sparse.exr full.exr --max-abs 0.125 --json -"));
  EXPECT_EQ(json["pixels"], 1);
  EXPECT_EQ(json["channels"], (nlohmann::json{"R", "G", "B"}));
  EXPECT_EQ(json["max_abs"], 0.125);
  EXPECT_EQ(json["max_relative"], 0.25);
  writeImage({2, 1, {"R", "G", "B", "sampled"}, std::vector<float>(8, 0.0f)}, folder / "none.exr", {});
  refuse("luciole compare none.exr full.exr --error-map out.png", 2, "sampled");
}

TEST_F(CommandLine, NonFiniteDifferencesNeverPass) {
  writeImage({1, 1, {"R", "G", "B"}, {1, 1, 1}}, folder / "a.npy", {});
  writeImage({1, 1, {"R", "G", "B"}, {1, NAN, 1}}, folder / "b.npy", {});
  const Outcome outcome = runLine(folder, "luciole compare a.npy b.npy --max-abs inf --json -");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_EQ(nlohmann::json::parse(outcome.out)["nonfinite"], 1);
  EXPECT_TRUE(nlohmann::json::parse(outcome.out)["max_abs"].is_null());
  succeed("luciole compare b.npy b.npy --max-abs 0");
}

TEST_F(CommandLine, CompareSaysWhyAFigureIsNull) {
  const Image black{1, 1, {"R", "G", "B"}, {0, 0, 0}};
  writeImage(black, folder / "black.npy", {});
  writeImage({1, 1, {"R", "G", "B"}, {1, 1, 1}}, folder / "white.npy", {});
  writeImage({1, 1, {"R", "G", "B"}, {NAN, NAN, NAN}}, folder / "nothing.npy", {});
  const auto reasons = [&](const std::string& pair) {
    const auto json = nlohmann::json::parse(succeed("luciole compare " + pair + " --json -"));
    std::vector<std::string> nulls, explained;
    for (const auto& [key, value] : json.items())
      if (value.is_null()) nulls.push_back(key);
    const auto found = json.value("reasons", nlohmann::json::object());
    for (const auto& [key, why] : found.items()) explained.push_back(key);
    EXPECT_EQ(nulls, explained) << json;
    return found;
  };
  EXPECT_EQ(reasons("black.npy black.npy"), (nlohmann::json{{"psnr", "no finite value differs"}}));
  EXPECT_EQ(reasons("white.npy black.npy"), nlohmann::json::object());
  EXPECT_EQ(reasons("black.npy white.npy"),
            (nlohmann::json{{"max_relative", "A is black, of which nothing is a share"},
                            {"mean_relative", "A is black, of which nothing is a share"}}));
  EXPECT_EQ(reasons("nothing.npy white.npy").size(), std::size(kImageMetrics));
  EXPECT_EQ(succeed("luciole compare nothing.npy white.npy").find("nan"), std::string::npos);
}

TEST_F(CommandLine, ShadowSizeBoundsTheMaps) {
  succeed("luciole render scene.json --shadows hard -o usual.npy");
  succeed("luciole render scene.json --shadows hard --shadow-size 2048 -o same.npy");
  succeed("luciole compare usual.npy same.npy --max-abs 0");
  succeed("luciole render scene.json --shadow-size 16 -o coarse.npy --shadows hard");
  EXPECT_EQ(runLine(folder, "luciole compare usual.npy coarse.npy --max-abs 0.01").status, 1);
  succeed("luciole gbuffer scene.json -o g.exr");
  succeed("luciole shade g.exr --scene scene.json --shadow-size 16 -o shaded.npy --shadows hard");
  succeed("luciole compare coarse.npy shaded.npy --max-abs 0");
  for (const char* size : {"15", "16385", "many"})
    refuse(std::string("luciole render scene.json -o out.png --shadow-size ") + size, 2, "--shadow-size");
}

TEST_F(CommandLine, ComparedPicturesOnStandardOutputStandAlone) {
  writeImage({1, 1, {"R", "G", "B"}, {1, 1, 1}}, folder / "a.exr", {});
  for (const char* option : {"--diff", "--error-map"}) {
    succeed(std::string("luciole compare a.exr a.exr ") + option +
            " file.png && luciole compare a.exr a.exr " + option +
            " - > piped.png && luciole compare file.png piped.png --max-abs 0");
  }
}

TEST_F(CommandLine, PicturesThatCannotBeComparedAreNamedAndLeaveNoFile) {
  writeImage({1, 1, {"R", "G", "B"}, {1, 1, 1}}, folder / "a.exr", {});
  writeImage({2, 1, {"R", "G", "B"}, {1, 1, 1, 1, 1, 1}}, folder / "wide.exr", {});
  writeImage({1, 1, {"Z"}, {1}}, folder / "depth.exr", {});
  const std::string outputs = " --diff out.png --error-map out_map.png --json out.json";
  refuse("luciole compare a.exr wide.exr" + outputs, 2, "a.exr, wide.exr: 1 x 1 and 2 x 1 pixels");
  refuse("luciole compare a.exr depth.exr" + outputs, 2, "'R G B' and 'Z'");
  refuse("luciole compare depth.exr depth.exr" + outputs, 2, "out.png");
  refuse("luciole compare a.exr a.exr --diff out.png --json nowhere/out.json", 2, "nowhere/out.json");
}

TEST_F(CommandLine, GeneratedLightsAreTheSameForTheSameSeedAndRender) {
  const std::string once = succeed("luciole generate lights --count 50 --seed 7");
  EXPECT_EQ(once, succeed("luciole generate lights --count 50 --seed 7"));
  EXPECT_NE(once, succeed("luciole generate lights --count 50 --seed 8"));
  EXPECT_EQ(nlohmann::json::parse(once)["lights"].size(), 50u);
  writeText(folder / "quad.obj", "v -1 0 -1\nv 1 0 -1\nv 1 0 1\nv -1 0 1\nf 4 3 2 1\n");
  succeed(
      "mkdir sub && luciole generate lights quad.obj --count 20 --intensity 3 -o sub/lit.json && luciole "
      "render sub/lit.json --size 32x18 -o out.png");
}

TEST_F(CommandLine, EveryShapeOfLightsIsGeneratedAndRendered) {
  writeText(folder / "lamps.csv", "x,y,z,r,g,b,range\n0,2,0,1,1,1,3\n1,2,0,1,0,0,\n");
  for (const char* options :
       {"--count 9", "--shape ball --count 9 --seed 3", "--shape sphere --radius 2 --count 9 --cutoff 0.01",
        "--shape surface --offset 0.2 --count 9 --density 2 --shadow",
        "--shape clusters --clusters 2 --count 9",
        "--shape curve --points -1,1,0,1,1,0,1,2,3 --radius 0.1 --count 9 --range 1,2", "--csv lamps.csv",
        "--min -1,0,-1 --max 1,2,1 --count 9"}) {
    succeed(std::string("mkdir -p sub && luciole generate lights scene.json -o sub/lit.json ") + options +
            " && luciole render sub/lit.json --size 32x18 --quiet -o out.png && rm out.png");
    const auto json = nlohmann::json::parse(readText(folder / "sub/lit.json"));
    EXPECT_EQ(json["lights"].size(), std::string(options).find("csv") == std::string::npos ? 9u : 2u)
        << options;
    EXPECT_FALSE(json.contains("light_fields"));
    EXPECT_EQ(json["fog"]["mode"], "exp2");
  }
}

TEST_F(CommandLine, OptionsOfLightsTakeNoMoreThanTheirNumbers) {
  const std::string lights =
      succeed("luciole generate lights --count 30 --shape curve --points 0,0,0,1,1,1 --range 1 scene.json");
  EXPECT_NE(lights.find("fog"), std::string::npos);
  EXPECT_EQ(lights, succeed("luciole generate lights --count 30 --range 1 --shape curve scene.json --points "
                            "0,0,0,1,1,1"));
  EXPECT_NE(succeed("luciole generate lights --count 30 --color 1,0,0 --color 0,1,0 scene.json").find("fog"),
            std::string::npos);
}

TEST_F(CommandLine, OptionsOfLightsThatContradictAreRefusedInOneLine) {
  writeText(folder / "lamps.csv", "0,2,0,1,1,1,3\n");
  writeText(folder / "empty.json", "{}");
  const std::string command = "luciole generate lights -o out.json ";
  refuse(command + "--shape cone", 2, "--shape cone: expected box, ball");
  refuse(command + "--shape surface", 2, "area of 0");
  refuse(command + "--shape ball --min 0,0,0", 2, "--min means nothing for --shape ball");
  refuse(command + "--center 0,0,0", 2, "--center means nothing for --shape box");
  refuse(command + "--shape curve --clusters 3", 2, "--clusters means nothing");
  refuse(command + "--shape curve --points 1,2,3", 2, "--points");
  refuse(command + "--shape curve --points 1,2,3,4", 2, "--points");
  refuse(command + "--csv lamps.csv --shape box", 2, "--shape");
  refuse(command + "--csv lamps.csv --color 1,1,1", 2, "--color means nothing beside --csv");
  refuse(command + "--csv lamps.csv --density 3", 2, "SCENE");
  refuse(command + "--csv lamps.csv --count 2", 2, "1 lights, expected 2");
  refuse(command + "--csv none.csv", 2, "none.csv");
  refuse(command + "--range 1 --density 2", 2, "--range");
  refuse(command + "--range 1 --cutoff 2", 2, "--range");
  refuse(command + "--density 1 --cutoff 2", 2, "--density");
  for (const char* other : {"--range 1", "--density 2", "--cutoff 2"})
    refuse(command + "--no-range " + other, 2, "--no-range");
  refuse(command + "--csv lamps.csv --no-range", 2, "SCENE");
  refuse(command + "--range 2,1", 2, "--range");
  refuse(command + "--range 1,2,3", 2, "--range");
  refuse(command + "--color 1,2", 2, "--color");
  refuse(command + "--min 1,2", 2, "--min");
  refuse(command + "--range 0", 2, "--range");
  refuse(command + "--min 3,0,0 --max 2,1,1", 2, "--min must not exceed --max");
  refuse(command + "empty.json", 2, "empty.json: its first camera sees nothing");
  refuse(command + "empty.json --min 0,0,0 --max 1,1,1", 2, "empty.json: its first camera sees nothing");
  refuse(command + "-", 2, "standard input");
  refuse(command + "none.json", 2, "none.json");
  succeed("luciole generate lights empty.json --min 0,0,0 --max 1,1,1 --range 1");
}

TEST_F(CommandLine, DevicesMarksTheOneThatWouldBeUsed) {
  EXPECT_NE(succeed("luciole devices").find("* "), std::string::npos);
}

TEST_F(CommandLine, EveryLaneWidthRendersThePicture) {
  succeed("luciole render scene.json -o native.npy");
  for (const char* lanes : {"1", "4", "8", "16"}) {
    succeed(std::string("luciole render scene.json --device ,lanes=") + lanes + " -o lanes.npy");
    succeed("luciole compare native.npy lanes.npy --max-abs 0");
  }
}

TEST_F(CommandLine, HelpAndVersionSucceed) {
  const std::string help = succeed("luciole help");
  for (const char* command : {"render", "gbuffer", "shade", "compare", "devices", "generate", "help", "test"})
    EXPECT_NE(help.find(command), std::string::npos) << command;
  EXPECT_NE(succeed("luciole help render").find("--samples"), std::string::npos);
  EXPECT_NE(succeed("luciole render --help").find("--samples"), std::string::npos);
  EXPECT_EQ(succeed("luciole --version").substr(0, 8), "luciole ");
}

// What a user can do wrong.

TEST_F(CommandLine, NoCommandIsWrongInput) { refuse("luciole", 2, "help"); }
TEST_F(CommandLine, UnknownCommandIsWrongInput) { refuse("luciole rendr scene.json -o out.png", 2, "rendr"); }
TEST_F(CommandLine, UnknownOptionIsNamed) {
  refuse("luciole render scene.json -o out.png --smples 3", 2, "--smples");
}
TEST_F(CommandLine, MissingSceneIsNamed) {
  refuse("luciole render nowhere.json -o out.png", 2, "nowhere.json");
}
TEST_F(CommandLine, UnknownExtensionIsRefusedBeforeAnyWork) {
  refuse("luciole render scene.json -o out.xyz", 2, "out.xyz");
}
TEST_F(CommandLine, ZeroSizeIsRefused) {
  refuse("luciole render scene.json --size 0x0 -o out.png", 2, "--size");
}
TEST_F(CommandLine, NegativeSizeIsRefused) {
  refuse("luciole render scene.json --size -5x10 -o out.png", 2, "--size");
}
TEST_F(CommandLine, HugeSizeIsRefused) {
  refuse("luciole render scene.json --size 100000x100000 -o out.png", 2, "--size");
}
TEST_F(CommandLine, SizeWithRubbishIsRefused) {
  refuse("luciole render scene.json --size 10x10x -o out.png", 2, "--size");
}
TEST_F(CommandLine, CropOutsideThePictureIsRefused) {
  refuse("luciole render scene.json --crop 90,0,10,10 -o out.png", 2, "--crop");
}
TEST_F(CommandLine, UnknownCameraIsRefused) {
  refuse("luciole render scene.json --camera 7 -o out.png", 2, "--camera");
}
TEST_F(CommandLine, UnknownAovIsNamed) {
  refuse("luciole render scene.json --aov norml -o out.exr", 2, "norml");
}
TEST_F(CommandLine, UnknownDeviceIsNamed) {
  refuse("luciole render scene.json --device abacus -o out.png", 2, "abacus");
}
TEST_F(CommandLine, ZeroSamplesAreRefused) {
  refuse("luciole render scene.json --samples 0 -o out.png", 2, "--samples");
}

TEST_F(CommandLine, LimitsThatNothingMeetsAreRefused) {
  for (const char* limit : {"nan", "-1", "x"})
    refuse(std::string("luciole compare a.exr b.exr --max-abs ") + limit, 2, "--max-abs");
}
TEST_F(CommandLine, OneFileForTwoOutputsIsRefused) {
  refuse("luciole compare a.exr b.exr --diff out.png --error-map out.png", 2,
         "out.png: named for two outputs");
  refuse("luciole compare a.exr b.exr --error-map - --json -", 2, "named for two outputs");
}

TEST_F(CommandLine, UnknownKeyIsNamed) {
  writeText(folder / "bad.json", R"({"objects": [], "lihgts": []})");
  refuse("luciole render bad.json -o out.png", 2, "lihgts");
}

TEST_F(CommandLine, NaNPositionIsRefused) {
  writeText(
      folder / "bad.json",
      R"({"objects": [{"primitive": "box"}], "lights": [{"type": "point", "position": ["NaN", 0, 0]}]})");
  refuse("luciole render bad.json -o out.png", 2, "lights[0].position");
  writeText(
      folder / "bad.json",
      R"({"objects": [{"primitive": "box"}], "lights": [{"type": "point", "position": [1e999, 0, 0]}]})");
  refuse("luciole render bad.json -o out.png", 2, "bad.json");
}

TEST_F(CommandLine, SingularMatrixIsRefused) {
  writeText(folder / "bad.json", R"({"objects": [{"primitive": "box", "scale": [1, 0, 1]}]})");
  refuse("luciole render bad.json -o out.png", 2, "scale");
}

TEST_F(CommandLine, MissingTextureIsNamed) {
  writeText(
      folder / "bad.json",
      R"({"materials": {"m": {"diffuse_map": "gone.png"}}, "objects": [{"primitive": "box", "material": "m"}]})");
  refuse("luciole render bad.json -o out.png", 2, "gone.png");
}

TEST_F(CommandLine, MissingFolderIsRefused) {
  refuse("luciole render scene.json -o nowhere/out.png", 2, "nowhere/out.png");
}

TEST_F(CommandLine, ReadOnlyFolderIsRefused) {
  // /proc takes no files from anyone, root included.
  refuse("luciole render scene.json -o /proc/out.png", 2, "/proc/out.png");
}

TEST_F(CommandLine, FullDiskLeavesNoPartOfAFile) {
  // A limit on file size fails writes as a full disk does; the shell ignores the signal that comes with it. A
  // G-buffer, because the limit would fail a kernel compiler's files too.
  refuse("(trap '' XFSZ; ulimit -f 1; luciole gbuffer scene.json --quiet -o out.exr)", 3, "out.exr");
}

TEST_F(CommandLine, NoOpenClDeviceIsTheMachinesFault) {
  refuse("OCL_ICD_VENDORS=/nonexistent luciole render scene.json -o out.png", 3, "no OpenCL device");
  refuse("OCL_ICD_VENDORS=/nonexistent luciole devices", 3, "no OpenCL device");
}

TEST_F(CommandLine, ExistingFileSurvivesAFailedWrite) {
  succeed("luciole gbuffer scene.json -o keep.exr && cp keep.exr copy.exr");
  EXPECT_EQ(
      runLine(folder, "(trap '' XFSZ; ulimit -f 1; luciole gbuffer scene.json --size 400x400 -o keep.exr)")
          .status,
      3);
  succeed("cmp keep.exr copy.exr");
}

}  // namespace
}  // namespace luciole::test
