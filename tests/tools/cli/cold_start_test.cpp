// First pictures, for which kernels are compiled quickly, and what helpers do beside and after them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <thread>

#include "cl/device.hpp"
#include "cl/pocl_cache.hpp"
#include "tools/cli/run_program.hpp"

namespace luciole::test {
namespace {

using testing::HasSubstr;
using testing::Not;

/// Three kernels: lists, exact shadows on smooth surfaces, and shading with highlights in fog.
constexpr const char* kScene = R"({
  "camera": {"eye": [2, 2, 5], "target": [0, 0.5, 0]}, "size": [160, 90], "ambient": 0.1,
  "fog": {"mode": "exp2", "density": 0.05, "color": [0.2, 0.3, 0.4]},
  "materials": {"m": {"diffuse": [0.6, 0.5, 0.4], "specular": 0.5, "shininess": 32}},
  "objects": [{"primitive": "plane", "scale": 8}, {"primitive": "sphere", "translate": [0, 1, 0], "material": "m"}],
  "lights": [{"type": "point", "position": [2, 3, 1], "shadow": true},
             {"type": "spot", "position": [-2, 4, 2], "target": [0, 0, 0], "cutoff": 40, "exponent": 4, "shadow": true}]
})";

struct ColdStart : testing::Test {
  TemporaryFolder folder;
  const std::string cold = "export POCL_CACHE_DIR=$PWD/kernels XDG_CACHE_HOME=$PWD/caches; ";
  const std::string render = "luciole render scene.json -o a.png --hash --stats stats.json";

  void SetUp() override {
    // Where everything is demanded, PoCL is.
    if (listDevices().at(selectDevice(listDevices(), "")).platform != kPoclPlatform) {
      ASSERT_EQ(std::getenv("LUCIOLE_SHARED"), nullptr);
      GTEST_SKIP() << "not PoCL";
    }
    writeText(folder / "scene.json", kScene);
    std::filesystem::create_directory(folder / "kernels");
  }

  std::ptrdiff_t programsListed() const {
    const std::string list = folder / "kernels/luciole-programs";
    if (!std::filesystem::is_regular_file(list)) return 0;
    const std::string text = readText(list);
    return std::count(text.begin(), text.end(), '\n');
  }

  /// Waits until the helper that outlives a command has listed `programs` and ended. Returns whether it did.
  bool awaitHelper(std::ptrdiff_t programs) const {
    for (int i = 0; i < 600; ++i) {
      const int lock = open((folder / "kernels/luciole-compiles").c_str(), O_WRONLY);
      const bool is_free = lock >= 0 && flock(lock, LOCK_EX | LOCK_NB) == 0;
      if (lock >= 0) close(lock);
      if (is_free && programsListed() >= programs) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    return false;
  }
};

TEST_F(ColdStart, TheFirstPictureHasTheBitsOfAllOthersAndTheNextProgramsAreOptimized) {
  const Outcome first = runLine(folder, cold + "LUCIOLE_HELPERS=1 " + render);
  EXPECT_EQ(first.status, 0) << first.err;
  EXPECT_THAT(first.err, Not(HasSubstr("warning")));
  const std::ptrdiff_t quick = programsListed();
  EXPECT_GE(quick, 4) << "three of the picture and the check's own";
  ASSERT_TRUE(awaitHelper(2 * quick + 2))
      << "each of them is optimized, one that counts lights, and the general one; its beams are those here";
  const Outcome second = runLine(folder, cold + render);
  EXPECT_EQ(nlohmann::json::parse(readText(folder / "stats.json"))["kernels_compiled"], 0);
  EXPECT_EQ(second.out, first.out);
  std::filesystem::remove_all(folder / "kernels");
  EXPECT_EQ(runLine(folder, cold + render).out, first.out) << "optimized from the start";
}

/// A matte scene without fog: other features, all of which the general program has.
constexpr const char* kMatteScene = R"({
  "camera": {"eye": [2, 2, 5], "target": [0, 0.5, 0]}, "size": [160, 90],
  "objects": [{"primitive": "plane", "scale": 8}, {"primitive": "box", "translate": [0, 1, 0]}],
  "lights": [{"type": "directional", "direction": [1, -2, -1], "shadow": true}]
})";

TEST_F(ColdStart, OnceTheGeneralProgramIsCompiledAFirstPictureTakesNoCompiler) {
  ASSERT_EQ(runLine(folder, cold + "luciole compile").status, 0);
  const std::ptrdiff_t general = programsListed();
  for (const char* scene : {kScene, kMatteScene}) {
    writeText(folder / "scene.json", scene);
    const std::ptrdiff_t before = programsListed();
    const Outcome first = runLine(folder, cold + "LUCIOLE_HELPERS=1 " + render);
    EXPECT_EQ(nlohmann::json::parse(readText(folder / "stats.json"))["kernels_compiled"], 0) << first.err;
    ASSERT_TRUE(awaitHelper(before + 1)) << "its own program is optimized";
    EXPECT_EQ(runLine(folder, cold + "LUCIOLE_HELPERS=1 " + render).out, first.out);
  }
  EXPECT_GE(programsListed(), general + 2);
}

TEST_F(ColdStart, WithoutHelpersNothingOutlivesACommand) {
  EXPECT_EQ(runLine(folder, cold + render).status, 0);
  EXPECT_EQ(programsListed(), 4);
  EXPECT_FALSE(std::filesystem::exists(folder / "kernels/luciole-compiles"));
}

TEST_F(ColdStart, TwoProgramsAtOnceDontSpoilEachOthersCache) {
  const std::string twice = cold + "LUCIOLE_HELPERS=1; export LUCIOLE_HELPERS; " + render + " > first & " +
                            "luciole render scene.json -o b.png --hash > second; wait; cat first second";
  const Outcome both = runLine(folder, twice);
  EXPECT_EQ(both.status, 0) << both.err;
  EXPECT_EQ(both.out.substr(0, 64), both.out.substr(both.out.find('\n') + 1, 64));
  ASSERT_TRUE(awaitHelper(8));
  EXPECT_EQ(runLine(folder, cold + render).out.substr(0, 64), both.out.substr(0, 64));
}

TEST_F(ColdStart, ACacheThatCantBeWrittenCostsTimeAndNoPicture) {
  if (geteuid() == 0) {
    // Whoever may write everywhere: a list that is a folder, and a place for checks that is a file.
    std::filesystem::create_directory(folder / "kernels/luciole-programs");
    writeText(folder / "caches", "");
  } else {
    std::filesystem::permissions(folder / "kernels", std::filesystem::perms::owner_read);
  }
  const Outcome outcome = runLine(folder, cold + "LUCIOLE_HELPERS=1 " + render);
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  std::filesystem::permissions(folder / "kernels", std::filesystem::perms::owner_all);
  ASSERT_TRUE(awaitHelper(0));
}

TEST_F(ColdStart, CompilingForAnotherProcessIsRefusedToPeople) {
  const Outcome outcome = runLine(folder, "luciole compile scene.json");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_TRUE(isOneLine(outcome.err)) << outcome.err;
}

}  // namespace
}  // namespace luciole::test
