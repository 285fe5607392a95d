#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "tools/cli/run_program.hpp"

namespace luciole::test {
namespace {

using testing::HasSubstr;

/// Neither lights nor textures: nothing but the start takes time.
constexpr const char* kPlainScene = R"({
  "camera": {"eye": [0, 0, 5], "target": [0, 0, 0]}, "size": [16, 16],
  "objects": [{"primitive": "box"}], "lights": [{"type": "directional", "direction": [0, 0, -1]}]
})";

constexpr const char* kNoDevice = "OCL_ICD_VENDORS=/nonexistent OCL_ICD_FILENAMES= ";

nlohmann::json statsOf(const TemporaryFolder& folder, const std::string& line) {
  const Outcome outcome = runLine(folder, line + " --quiet --stats stats.json");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  return nlohmann::json::parse(readText(folder / "stats.json"));
}

TEST(Start, StatsTellAColdOneFromAWarmOne) {
  const TemporaryFolder folder;
  writeText(folder / "scene.json", kPlainScene);
  const std::string line = "export POCL_CACHE_DIR=$PWD/kernels; luciole render scene.json -o a.png";
  const nlohmann::json cold = statsOf(folder, line), warm = statsOf(folder, line);
  // Others need not have a cache to look into; where everything is demanded, PoCL is.
  if (cold["device"]["platform"] != "Portable Computing Language") {
    ASSERT_EQ(std::getenv("LUCIOLE_SHARED"), nullptr) << cold["device"]["platform"];
    GTEST_SKIP() << "not PoCL";
  }
  EXPECT_GE(cold["kernels_compiled"], 1);
  EXPECT_EQ(warm["kernels_compiled"], 0);
  for (const nlohmann::json& stats : {cold, warm}) {
    // Opening and compiling follow each other, within the process.
    EXPECT_GT(stats["cold_start_milliseconds"], 0);
    EXPECT_LT(stats["cold_start_milliseconds"], stats["wall_milliseconds"]);
  }
  // A compiler's work on any kernel is many times that of looking it up.
  EXPECT_LT(warm["cold_start_milliseconds"], cold["cold_start_milliseconds"]);
}

TEST(Start, WhatAShellDidBeforeItBecameTheProgramIsNotTheProgramsTime) {
  const TemporaryFolder folder;
  writeText(folder / "scene.json", kPlainScene);
  const auto begin = std::chrono::steady_clock::now();
  const nlohmann::json stats =
      statsOf(folder, "sleep 0.5; exec '" LUCIOLE_BINARY "' render scene.json -o a.png");
  const std::chrono::duration<double, std::milli> outside = std::chrono::steady_clock::now() - begin;
  EXPECT_LE(stats["wall_milliseconds"], outside.count() - 500);
}

TEST(Start, WallTimeIsThatOfTheProcess) {
  const TemporaryFolder folder;
  writeText(folder / "scene.json", kPlainScene);
  const auto begin = std::chrono::steady_clock::now();
  const nlohmann::json stats = statsOf(folder, "luciole render scene.json -o a.png");
  const std::chrono::duration<double, std::milli> outside = std::chrono::steady_clock::now() - begin;
  EXPECT_LE(stats["wall_milliseconds"], outside.count());
}

TEST(Start, WhatNeedsNoPictureLoadsNoOpenImageIO) {
  const TemporaryFolder folder;
  writeText(folder / "scene.json", kPlainScene);
  for (const char* line : {"luciole --version", "luciole help", "luciole render scene.json -o a.png"}) {
    const Outcome outcome = runLine(folder, std::string("export LD_DEBUG=files; ") + line);
    EXPECT_EQ(outcome.status, 0);
    EXPECT_THAT(outcome.err, HasSubstr("libtbb")) << "else the loader says nothing";
    EXPECT_THAT(outcome.err, testing::Not(HasSubstr("OpenImageIO"))) << line;
  }
}

TEST(Start, ABadSceneIsToldBeforeABadDevice) {
  const TemporaryFolder folder;
  for (const char* device : {"", "--device nosuch"}) {
    const Outcome outcome =
        runLine(folder, kNoDevice + std::string("luciole render missing.json -o a.png ") + device);
    EXPECT_EQ(outcome.status, 2);
    EXPECT_TRUE(isOneLine(outcome.err)) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("missing.json"));
  }
}

TEST(Start, ABadOptionIsToldBeforeABadDevice) {
  const TemporaryFolder folder;
  writeText(folder / "scene.json", kPlainScene);
  const Outcome outcome =
      runLine(folder, kNoDevice + std::string("luciole render scene.json -o a.png --size 0x0"));
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, HasSubstr("--size"));
}

TEST(Start, NoDeviceIsOneLineAndStatus3) {
  const TemporaryFolder folder;
  writeText(folder / "scene.json", kPlainScene);
  for (const char* output : {"a.png", "a.exr"}) {
    const Outcome outcome =
        runLine(folder, kNoDevice + std::string("luciole render scene.json -o ") + output);
    EXPECT_EQ(outcome.status, 3);
    EXPECT_TRUE(isOneLine(outcome.err)) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("no OpenCL device"));
    EXPECT_FALSE(std::filesystem::exists(folder / output));
  }
}

// Whoever may write to a folder above the library's could have it load anything.
TEST(Start, WithoutItsModuleTheProgramSaysWhatIsMissingAndLooksNowhereElse) {
  const TemporaryFolder folder;
  writeText(folder / "scene.json", kPlainScene);
  const Outcome outcome =
      runLine(folder, "library=\"$(dirname '" LUCIOLE_BINARY
                      "')/lib\" && mkdir below && cd below && "
                      "cp \"$library\"/libluciole.so.* . && ln -s \"$library/luciole\" .. && "
                      "LD_LIBRARY_PATH=\"$PWD\" '" LUCIOLE_BINARY "' render ../scene.json -o a.tif");
  EXPECT_EQ(outcome.status, 3);
  EXPECT_TRUE(isOneLine(outcome.err)) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("libluciole_image.so"));
}

}  // namespace
}  // namespace luciole::test
