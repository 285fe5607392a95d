// One picture a frame: render --frames, --resume and --shard, and --frames of the other commands.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "scene/gltf/gltf_file.hpp"
#include "tools/cli/program_test.hpp"

namespace luciole::test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

/// A camera, a light and an object that move, in a small picture.
constexpr const char* kMovingScene = R"({
  "camera": {"orbit": [0, 20, 6], "target": [0, 0.5, 0],
             "keys": [{"frame": 1, "orbit": [0, 20, 6]}, {"frame": 9, "orbit": [360, 20, 6]}]},
  "size": [48, 27], "ambient": 0.1,
  "objects": [{"primitive": "plane", "scale": 10},
              {"primitive": "box", "interpolation": "smooth",
               "keys": [{"frame": 1, "translate": [-2, 1, 0], "scale": 0.5}, {"frame": 5, "translate": [2, 1, 0]},
                        {"frame": 9, "rotate": [0, 90, 0]}]}],
  "lights": [{"type": "directional", "direction": [-1, -2, -1], "color": 0.5, "shadow": true},
             {"type": "spot", "position": [0, 4, 0], "target": [0, 0, 0], "cutoff": 30, "shadow": true,
              "keys": [{"frame": 1, "position": [-3, 4, 0], "intensity": 1}, {"frame": 9, "position": [3, 4, 1], "intensity": 3}]}]
})";

/// Its frame 3, worked out by hand: all numbers are exact.
constexpr const char* kThirdFrame = R"({
  "camera": {"orbit": [90, 20, 6], "target": [0, 0.5, 0]}, "size": [48, 27], "ambient": 0.1,
  "objects": [{"primitive": "plane", "scale": 10},
              {"primitive": "box", "translate": [0, 1, 0], "scale": 0.5, "rotate": [0, 90, 0]}],
  "lights": [{"type": "directional", "direction": [-1, -2, -1], "color": 0.5, "shadow": true},
             {"type": "spot", "position": [-1.5, 4, 0.25], "target": [0, 0, 0], "cutoff": 30, "shadow": true, "intensity": 1.5}]
})";

class Frames : public ProgramTest {
 protected:
  Frames() { writeText(folder / "scene.json", kMovingScene); }

  /// The names that start so, in order.
  std::vector<std::string> files(const std::string& start) {
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
      const std::string name = entry.path().filename().string();
      if (name.starts_with(start)) names.insert(name);
    }
    return {names.begin(), names.end()};
  }
  void refuse(const std::string& line, const std::string& what) {
    ProgramTest::refuse(line, 2, what);
    EXPECT_TRUE(files("f.").empty()) << line;
  }
};

using Names = std::vector<std::string>;

TEST_F(Frames, EachOfARangeIsThatFrameRenderedAlone) {
  succeed("luciole render scene.json --frames 1-9 -o f.###.exr");
  EXPECT_EQ(files("f."), (Names{"f.001.exr", "f.002.exr", "f.003.exr", "f.004.exr", "f.005.exr", "f.006.exr",
                                "f.007.exr", "f.008.exr", "f.009.exr"}));
  for (const int frame : {1, 3, 8}) {
    succeed(fmt::format("luciole render scene.json --frames {} -o alone.exr", frame));
    expectSamePicture(fmt::format("f.00{}.exr", frame), "alone.exr");
  }
  EXPECT_EQ(runLine(folder, "luciole compare f.001.exr f.002.exr --max-abs 0").status, 1);
}

TEST_F(Frames, AMeshThatDeformsHasTheShadowOfItsFrame) {
  // A square above a floor, which a morph target slides aside: from x of -2 at frame 1 to 0 at frame 13.
  GltfFile file;
  const int position = file.addAccessor<float>("VEC3", kFloat, 3, {-3, 1, 1, -1, 1, 1, -1, 1, -1, -3, 1, -1});
  const int indices = file.addAccessor<std::uint16_t>("SCALAR", kUnsignedShort, 1, {0, 1, 2, 0, 2, 3});
  const int target = file.addAccessor<float>("VEC3", kFloat, 3, {4, 0, 0, 4, 0, 0, 4, 0, 0, 4, 0, 0});
  const int times = file.addAccessor<float>("SCALAR", kFloat, 1, {0, 1});
  const int weights = file.addAccessor<float>("SCALAR", kFloat, 1, {0, 1});
  file.root["meshes"] = {{{"primitives",
                           {{{"attributes", {{"POSITION", position}}},
                             {"indices", indices},
                             {"targets", {{{"POSITION", target}}}}}}}}};
  file.root["animations"] = {
      {{"samplers", {{{"input", times}, {"output", weights}}}},
       {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}}}}}};
  file.root["buffers"] = {{{"byteLength", file.data.size()}, {"uri", "data.bin"}}};
  writeText(folder / "data.bin", file.data);
  writeText(folder / "slide.gltf", file.root.dump());
  writeText(folder / "slide.json", R"({"size": [64, 48], "camera": {"eye": [0, 3, 6], "target": [0, 0, 0]},
      "objects": [{"mesh": "slide.gltf"}, {"primitive": "plane", "scale": 8}],
      "lights": [{"type": "point", "position": [0.5, 4, 0], "shadow": true},
                 {"type": "spot", "position": [3, 3, 1], "target": [0, 0, 0], "cutoff": 40, "shadow": true}]})");
  for (const char* shadows : {"hard", "pcf", "exact", "auto"}) {
    succeed(fmt::format("luciole render slide.json --frames 1-13x4 --shadows {} -o f.##.exr", shadows));
    for (const int frame : {5, 13}) {
      succeed(fmt::format("luciole render slide.json --frames {} --shadows {} -o alone.exr", frame, shadows));
      expectSamePicture(fmt::format("f.{:02}.exr", frame), "alone.exr");
    }
  }
  // Where it is at frame 13, a still one casts the same shadow.
  file.root.erase("animations");
  file.root["meshes"][0]["weights"] = {0.5};
  writeText(folder / "slide.gltf", file.root.dump());
  succeed("luciole render slide.json --shadows exact -o still.exr");
  succeed("luciole render slide.json --shadows off -o off.exr");
  EXPECT_EQ(runLine(folder, "luciole compare still.exr off.exr --max-abs 0.1").status, 1);
  succeed("rm f.*");
}

TEST_F(Frames, OneIsTheSceneThatAHandHasPosed) {
  // Smooth through two keys is straight, and a member that one key alone names stays.
  writeText(folder / "hand.json", kThirdFrame);
  succeed("luciole render scene.json --frames 3 -o a.exr && luciole render hand.json -o b.exr");
  expectSamePicture("a.exr", "b.exr");
}

TEST_F(Frames, WithoutTheOptionASceneShowsItsFirst) {
  succeed("luciole render scene.json -o a.exr && luciole render scene.json --frames 1 -o b.exr");
  expectSamePicture("a.exr", "b.exr");
}

TEST_F(Frames, EveryStageTakesTheSameOne) {
  succeed(
      "luciole render scene.json --frames 4 -o f.##.exr && luciole gbuffer scene.json --frames 4 -o g.#.exr");
  EXPECT_EQ(files("f."), Names{"f.04.exr"});
  succeed("luciole shade g.4.exr --scene scene.json --frames 4 -o shaded.exr");
  expectSamePicture("f.04.exr", "shaded.exr");
  // The same surfaces and lights as the double precision reference's; other frames differ by far more.
  succeed("luciole render scene.json --frames 4 --shadows off -o plain.exr");
  succeed("luciole reference scene.json --frames 4 --shadows off -o truth.exr");
  // 1e-5 of the maximum is what the reference's own tests promise of any scene; nothing here is brighter
  // than 4.
  succeed("luciole compare plain.exr truth.exr --max-abs 4e-5");
  EXPECT_EQ(runLine(folder,
                    "luciole reference scene.json --frames 5 --shadows off -o t5.exr && "
                    "luciole compare plain.exr t5.exr --max-abs 4e-5")
                .status,
            1);
  succeed("rm f.04.exr");
  for (const char* command :
       {"gbuffer scene.json", "reference scene.json", "shade g.4.exr --scene scene.json"})
    refuse(fmt::format("luciole {} --frames 1-2 -o f.#.exr", command), "expected one frame");
}

TEST_F(Frames, WhatIsFlattenedAtAFrameIsNotThere) {
  const auto scene = [](const std::string& objects) {
    return R"({"camera": {"eye": [0, 3, 6], "target": [0, 0, 0]}, "size": [48, 27], "objects": [)" + objects +
           R"(], "lights": [{"type": "point", "position": [0, 4, 1], "radius": 0.2, "shadow": true}]})";
  };
  const std::string ground = R"({"primitive": "plane", "scale": 5})";
  const std::string box =
      R"({"primitive": "box", "keys": [{"frame": 1, "scale": 1}, {"frame": 3, "scale": -1}]})";
  writeText(folder / "scene.json", scene(ground + "," + box));
  writeText(folder / "bare.json", scene(ground));
  for (const char* options : {"--shadows exact", "--shadows soft --shading gouraud", "--shading flat"}) {
    succeed(fmt::format("luciole render scene.json --frames 2 -o a.exr {}", options));
    succeed(fmt::format("luciole render bare.json -o b.exr {}", options));
    expectSamePicture("a.exr", "b.exr");
  }
  succeed("luciole reference scene.json --frames 2 -o a.exr && luciole reference bare.json -o b.exr");
  expectSamePicture("a.exr", "b.exr");
  writeText(folder / "scene.json", scene(box));
  succeed("luciole render scene.json --shadows exact --frames 1-3 -o alone.#.exr");
}

TEST_F(Frames, ARangeOfOneIsARangeToo) {
  succeed("luciole render scene.json --frames 7-7 -o f.####.png");
  EXPECT_EQ(files("f."), Names{"f.0007.png"});
}

TEST_F(Frames, ListsNameFramesRangesAndSteps) {
  succeed("luciole render scene.json --size 8x8 --frames 1,3,10-30x5,12-13,3 -o f.##.png");
  EXPECT_EQ(files("f."), (Names{"f.01.png", "f.03.png", "f.10.png", "f.12.png", "f.13.png", "f.15.png",
                                "f.20.png", "f.25.png", "f.30.png"}));
  succeed("rm f.*");
  succeed("luciole render scene.json --size 8x8 --frames 10-14x3 -o f.#.png");
  EXPECT_EQ(files("f."), (Names{"f.10.png", "f.13.png"})) << "the last need not be one of them";
  succeed(
      "luciole render scene.json --frames 5,3 -o f.#.exr && luciole render scene.json --frames 3 -o a.exr");
  expectSamePicture("f.3.exr", "a.exr");
}

TEST_F(Frames, ListsAreResumedAndSharedByTheirOrder) {
  const std::string line = "luciole render scene.json --size 8x8 --frames 9,1,4-8x2 -o f.#.png ";
  succeed(line + "--shard 1/2");
  EXPECT_EQ(files("f."), (Names{"f.4.png", "f.8.png", "f.9.png"}));
  EXPECT_THAT(told(line + "--resume"), StartsWith("there already: 3 of 5 frames\n"));
  EXPECT_EQ(files("f.").size(), 5u);
}

TEST_F(Frames, NamesMayHoldThePlaceAsPrintfDoes) {
  succeed("luciole render scene.json --size 8x8 --frames 7,12 -o f.%03d.png --stats f.%d.json");
  EXPECT_EQ(files("f."), (Names{"f.007.png", "f.012.png", "f.12.json", "f.7.json"}));
  succeed("rm f.* && luciole render scene.json --size 8x8 --frames 3 -o 'f.50%%.#.png'");
  EXPECT_EQ(files("f."), Names{"f.50%.3.png"});
  succeed("rm f.* && luciole render scene.json --size 8x8 --frames 3 -o 'f.#5.%02d.png'");
  EXPECT_EQ(files("f."), Names{"f.#5.03.png"}) << "beside % a mark is a mark";
  succeed("rm f.* && luciole render scene.json --size 8x8 -o 'f.%04d%s.png'");
  EXPECT_EQ(files("f."), Names{"f.%04d%s.png"}) << "without --frames a name is a name";
  succeed("rm f.* && mkdir '%s' && luciole render scene.json --size 8x8 --frames 3 -o '%s/f.%d.png'");
  succeed("mv '%s/f.3.png' f.png");
  for (const char* command : {"gbuffer scene.json", "reference scene.json"})
    succeed(fmt::format("luciole {} --size 8x8 --frames 4 -o g.%02d.exr && mv g.04.exr g.exr", command));
  succeed(
      "luciole gbuffer scene.json --size 8x8 --frames 4 -o g.exr && "
      "luciole shade g.exr --scene scene.json --frames 4 -o h.%02d.exr && mv h.04.exr h.exr");
}

TEST_F(Frames, OtherPercentSignsAreRefused) {
  for (const char* name : {"f.%s.png", "f.%4d.png", "f.%00d.png", "f.%04x.png", "f.%d.%d.png", "f.%.png",
                           "f.50%.#.png", "f.%10d.png"}) {
    for (const char* frames : {"1-2", "1"})
      refuse(fmt::format("luciole render scene.json --frames {} -o '{}'", frames, name),
             "expected %04d once, for the frame's number, and %% for a percent sign");
  }
}

TEST_F(Frames, OneThatFailsIsToldAndTheOthersAreMade) {
  // Frame 2's file is a folder; at frame 5 the camera is above its target.
  writeText(folder / "scene.json", R"({"camera": {"eye": [0, 9, 4], "target": [0, 0, 0], "keys": [
      {"frame": 1, "eye": [0, 9, 4]}, {"frame": 9, "eye": [0, 9, -4]}]}, "size": [16, 9], "objects": [{"primitive": "box"}]})");
  std::filesystem::create_directory(folder / "f.2.png");
  const Outcome outcome = runLine(folder, "luciole render scene.json --frames 1-7 -o f.#.png --quiet");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, StartsWith("luciole: frame 2: f.2.png: "));
  EXPECT_THAT(outcome.err, HasSubstr("\nluciole: frame 5: scene.json: camera 0 at frame 5: up is parallel"));
  EXPECT_TRUE(outcome.err.ends_with("\nluciole: 2 of 7 frames failed: 2, 5\n")) << outcome.err;
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 3) << outcome.err;
  EXPECT_EQ(files("f."), (Names{"f.1.png", "f.2.png", "f.3.png", "f.4.png", "f.6.png", "f.7.png"}));
}

TEST_F(Frames, ResumeMakesTheMissingAndTouchesNoOther) {
  succeed(
      "luciole render scene.json --frames 1-5 -o f.#.exr && cp f.2.exr kept.exr && rm f.1.exr f.5.exr && : > "
      "f.4.exr");
  const auto written = std::filesystem::last_write_time(folder / "f.2.exr");
  const std::string text = readText(folder / "f.2.exr");
  const std::string said = told("luciole render scene.json --frames 1-6 -o f.#.exr --resume");
  EXPECT_THAT(said, StartsWith("there already: 2 of 6 frames\n"));
  EXPECT_EQ(files("f.").size(), 6u);
  EXPECT_EQ(std::filesystem::last_write_time(folder / "f.2.exr"), written);
  EXPECT_EQ(readText(folder / "f.2.exr"), text);
  for (const int frame : {1, 4, 6}) {
    succeed(fmt::format("luciole render scene.json --frames {} -o alone.exr", frame));
    expectSamePicture(fmt::format("f.{}.exr", frame), "alone.exr");
  }
  EXPECT_EQ(told("luciole render scene.json --frames 1-6 -o f.#.exr --resume --quiet"), "");
}

TEST_F(Frames, KilledAndResumedTheyAreWhatTheyWouldHaveBeen) {
  const std::string line = "luciole render scene.json --size 320x180 --samples 4 --frames 1-8 --quiet -o ";
  // Killed as soon as there are two; what is there is whole.
  runLine(folder, line + "f.#.exr & while [ ! -e f.2.exr ]; do sleep 0.01; done; kill -9 $!; wait");
  EXPECT_LT(files("f.").size(), 8u);
  EXPECT_EQ(files(".luciole").size(), 0u);
  succeed(line + "f.#.exr --resume && " + line + "whole.#.exr");
  for (int frame = 1; frame <= 8; ++frame)
    expectSamePicture(fmt::format("f.{}.exr", frame), fmt::format("whole.{}.exr", frame));
}

TEST_F(Frames, ShardsShareThem) {
  const std::string line = "luciole render scene.json --frames 4-8 -o f.#.png --shard ";
  succeed(line + "2/3");
  EXPECT_EQ(files("f."), (Names{"f.5.png", "f.8.png"}));
  succeed(line + "1/3 && " + line + "3/3");
  EXPECT_EQ(files("f.").size(), 5u);
  succeed("rm f.*");
  EXPECT_EQ(told(line + "7/7 --quiet"), "") << "there are only five frames";
  EXPECT_TRUE(files("f.").empty());
}

TEST_F(Frames, TasksOfASlurmArrayShareThemAndSaySo) {
  const std::string slurm =
      "export SLURM_ARRAY_TASK_COUNT=2 SLURM_ARRAY_TASK_MIN=1 SLURM_ARRAY_TASK_MAX=2 SLURM_ARRAY_TASK_STEP=1 "
      "SLURM_ARRAY_TASK_ID=";
  const std::string line = "; luciole render scene.json --frames 1-4 -o f.#.png";
  EXPECT_THAT(told(slurm + "2" + line), StartsWith("shard 2/2 of the frames"));
  EXPECT_EQ(files("f."), (Names{"f.2.png", "f.4.png"}));
  EXPECT_EQ(told(slurm + "1" + line + " --quiet"), "");
  EXPECT_EQ(files("f.").size(), 4u);
  succeed("rm f.*");
  succeed(slurm + "1; luciole render scene.json --frames 3 -o f.#.png");
  EXPECT_EQ(files("f."), Names{"f.3.png"}) << "a frame named alone is meant";
  succeed("rm f.*");
  refuse(slurm + "7" + line, "SLURM_ARRAY_TASK_ID");
}

TEST_F(Frames, StatisticsAreOneFileAFrame) {
  succeed("luciole render scene.json --frames 1-2 -o f.#.png --stats cost.##.json");
  for (const char* name : {"cost.01.json", "cost.02.json"}) {
    const nlohmann::json stats = nlohmann::json::parse(readText(folder / name));
    EXPECT_EQ(stats["counts"]["pixels_lit"] > 0, true) << name;
    bool loads = false, opens = false;
    for (const auto& stage : stats["stages"]) {
      loads |= stage["name"] == "load scene";
      opens |= stage["name"] == "open device" && stage["milliseconds"] > 0;
    }
    EXPECT_EQ(loads, std::string(name) == "cost.01.json") << "it is loaded once";
    EXPECT_EQ(opens, std::string(name) == "cost.01.json") << "the device is opened once";
  }
}

TEST_F(Frames, StatisticsTellEachFramesOwnTime) {
  succeed("luciole render scene.json --frames 1-3 -o f.#.png --stats cost.#.json");
  double frames = 0;
  for (const char* name : {"cost.1.json", "cost.2.json", "cost.3.json"}) {
    const nlohmann::json stats = nlohmann::json::parse(readText(folder / name));
    double shares = 0;
    for (const auto& stage : stats["stages"]) shares += stage["wall_milliseconds"].get<double>();
    const double frame = stats["picture_milliseconds"];
    EXPECT_LE(shares, frame) << name;
    // The first frame's time begins with the process, and each other's where the one before has ended.
    frames += frame;
    EXPECT_LE(frames, stats["wall_milliseconds"]) << name;
  }
}

TEST_F(Frames, WhatCannotBeMeantIsRefused) {
  for (const char* frames : {"a", "", "1-", "-3", "5-4", "1-2-3", "1.5", "1-99999999999", "10000000", "1,",
                             ",1", "1,,2", "1-9x0", "1-9x", "1x2", "1-9x-1", "1-9x2x2", "9-1x2", "1, 2"})
    if (*frames)
      refuse(fmt::format("luciole render scene.json -o f.#.png --frames='{}'", frames), "expected a frame");
  const std::string render = "luciole render scene.json ";
  refuse(render + "--frames 1-2 -o f.png", "-o f.png: expected a name with ####");
  refuse(render + "--frames 1-2 -o -", "-o -: expected a name with ####");
  refuse(render + "--frames 1-2 -o f.#.png --stats s.json", "--stats s.json: expected a name with ####");
  refuse(render + "--frames 1-2 -o nowhere/f.#.png", "nowhere");
  refuse(render + "--frames 1-2 -o f.#.xyz", "xyz");
  refuse(render + "--frames 1-2 -o f.#.png --camera 7", "--camera 7");
  refuse(render + "--frames 1-2 -o f.#.png --shard 3/2", "--shard 3/2: expected I/N");
  refuse(render + "--frames 1 -o f.#.png --shard 1/2", "--shard: goes with --frames A-B");
  refuse(render + "-o f.png --resume", "--resume: goes with --frames A-B");
  EXPECT_EQ(
      runLine(folder, "OCL_ICD_VENDORS=/nonexistent OCL_ICD_FILENAMES= " + render + "--frames 1-9 -o f.#.png")
          .status,
      3);
}

TEST_F(Frames, OnlyTheLastRunOfMarksInTheNameIsTheNumber) {
  std::filesystem::create_directory(folder / "shot#1");
  succeed(
      "luciole render scene.json --frames 12-12 -o 'shot#1/a#b.###.png' && mv 'shot#1/a#b.012.png' f.png");
  succeed("luciole render scene.json -o 'f.#.png'");
  EXPECT_EQ(files("f."), (Names{"f.#.png", "f.png"})) << "without --frames a mark is a mark";
}

}  // namespace
}  // namespace luciole::test
