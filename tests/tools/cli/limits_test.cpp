// The program where memory is limited, by ulimit or a control group: it does its work or says in one line
// what it needs, and ends with status 3.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "long_run.hpp"
#include "tools/cli/run_program.hpp"

namespace luciole::test {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::AnyOf;
using testing::HasSubstr;

/// The sanitizers' own memory, terabytes of addresses, can't be limited.
#if defined(__SANITIZE_ADDRESS__)
constexpr bool kCanLimit = false;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
constexpr bool kCanLimit = false;
#else
constexpr bool kCanLimit = true;
#endif
#else
constexpr bool kCanLimit = true;
#endif

class Limits : public testing::Test {
 protected:
  void SetUp() override {
    if (!kCanLimit) GTEST_SKIP() << "sanitizers take more addresses than any limit leaves";
    writeText(folder / "scene.json", kSmallScene);
  }

  /// Runs the line, and expects success without a word, or status 3 and one line. Returns the status.
  int expectDoneOrRefused(const std::string& line) {
    const Outcome outcome = runLine(folder, line);
    EXPECT_THAT(outcome.status, AnyOf(0, 3)) << line << "\n" << outcome.err;
    if (outcome.status == 0) {
      EXPECT_EQ(outcome.err, "") << line;
    } else {
      EXPECT_TRUE(isOneLine(outcome.err)) << line << "\n" << outcome.err;
      for (const auto& entry : fs::directory_iterator(folder.path()))
        EXPECT_THAT(entry.path().filename().string(), Not(testing::StartsWith("out"))) << line;
    }
    fs::remove(folder / "out.png");
    fs::remove(folder / "out.exr");
    return outcome.status;
  }

  TemporaryFolder folder;
};

TEST_F(Limits, OfAddressesLetTheProgramWorkOrEndInOneLine) {
  // MiB from too little to enough; below the first the system can't even start the program.
  for (const char* command :
       {"render scene.json --quiet -o out.png", "reference scene.json --quiet -o out.exr",
        "gbuffer scene.json --quiet -o out.exr"})
    for (const int mebibytes : {200, 320, 440, 500, 560, 640, 720, 800, 900, 1100, 1400})
      expectDoneOrRefused(fmt::format("ulimit -v {} && luciole {}", mebibytes * 1024, command));
}

TEST_F(Limits, OfDataLetTheProgramWorkOrEndInOneLine) {
  for (const int mebibytes : {16, 32, 64, 128, 192, 256, 320, 400, 600})
    expectDoneOrRefused(
        fmt::format("ulimit -d {} && luciole render scene.json --quiet -o out.png", mebibytes * 1024));
}

TEST_F(Limits, LetKernelsBeCompiledOrEndInOneLine) {
  // Nothing is in these caches. What hangs is killed.
  std::vector<const char*> limits{"-v 620000", "-v 845000", "-d 200000"};
  if (longRun()) limits.insert(limits.end(), {"-v 780000", "-v 860000", "-d 380000"});
  for (const char* limit : limits)
    expectDoneOrRefused(
        fmt::format("ulimit {} && POCL_CACHE_DIR=\"cache {}\" timeout -s KILL 240 '" LUCIOLE_BINARY
                    "' render scene.json --quiet --shadows exact -o out.png",
                    limit, limit));
}

TEST_F(Limits, WhatIsNeededAndWhatMayBeUsedIsTold) {
  writeText(folder / "many.json",
            R"({"light_fields": [{"count": 9000000, "min": [0, 0, 0], "max": [1, 1, 1]}]})");
  writeText(folder / "floor.json", R"({"objects": [{"name": "floor", "primitive": "plane"}]})");
  // A million vertices that no buffer holds, which 64 nodes deform.
  std::string nodes = R"({"translation": [0, 0, 0]})", shown;
  for (int i = 1; i <= 64; ++i) {
    nodes += R"(, {"mesh": 0, "skin": 0})";
    shown += fmt::format("{}{}", i == 1 ? "" : ", ", i);
  }
  writeText(folder / "crowd.gltf",
            fmt::format(R"({{"asset": {{"version": "2.0"}}, "scenes": [{{"nodes": [0, {}]}}],
      "nodes": [{}], "skins": [{{"joints": [0]}}],
      "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0, "JOINTS_0": 1, "WEIGHTS_0": 2}}}}]}}],
      "accessors": [{{"componentType": 5126, "count": 1000000, "type": "VEC3"}},
                    {{"componentType": 5121, "count": 1000000, "type": "VEC4"}},
                    {{"componentType": 5126, "count": 1000000, "type": "VEC4"}}]}})",
                        shown, nodes));
  for (const char* command :
       {"luciole info crowd.gltf", "luciole gbuffer scene.json --size 8192x8192 -o out.exr",
        "luciole bake floor.json --object floor --size 16384x16384 -o out.exr",
        "luciole reference scene.json --size 8192x8192 -o out.exr",
        "luciole reference many.json -o out.exr"}) {
    const Outcome outcome = runLine(folder, std::string("ulimit -v 1400000 && ") + command);
    EXPECT_EQ(outcome.status, 3) << command << outcome.err;
    EXPECT_TRUE(isOneLine(outcome.err)) << outcome.err;
    EXPECT_THAT(outcome.err, AllOf(HasSubstr(" needs "), HasSubstr("may use "), HasSubstr("ulimit -v")))
        << command;
  }
}

TEST_F(Limits, WithLittleMemoryBandsAreSmallerAndThePictureIsTheSame) {
  // Its pixels take about 490 MiB. Of the addresses, OpenCL takes half, and a quarter of the rest is for a
  // band.
  const std::string picture = "render scene.json --size 2400x1800 --quiet";
  const unsigned kibibytes = (1400 + 16 * std::thread::hardware_concurrency()) * 1024;
  ASSERT_EQ(runLine(folder, "luciole " + picture + " -o usual.png").status, 0);
  const Outcome outcome =
      runLine(folder, fmt::format("ulimit -v {} && luciole {} -o little.png", kibibytes, picture));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(runLine(folder, "luciole compare usual.png little.png --max-abs 0").status, 0);
}

// Their tree and what it is made of take some 300 bytes a light.
TEST_F(Limits, OfAddressesLetClustersOfLightsWorkOrEndInOneLine) {
  writeText(folder / "many.json",
            R"({"size": [128, 72], "camera": {"eye": [0, 3, 5], "target": [0, 0, 0], "fov_y": 15},
    "objects": [{"primitive": "plane", "scale": 4}], "light_fields":
    [{"count": 400000, "min": [-4, 0.1, -4], "max": [4, 3, 4], "attenuation": [0, 0, 1], "intensity": 1e-5}]})");
  const int enough = 1400 + 16 * int(std::thread::hardware_concurrency());
  for (const int mebibytes : {540, 580, 620, 660, 700, 740, 800, enough}) {
    const int status = expectDoneOrRefused(fmt::format(
        "ulimit -v {} && luciole render many.json --quiet --light-error 1/64 -o out.png", mebibytes * 1024));
    if (mebibytes == enough) {
      EXPECT_EQ(status, 0);
    }
  }
}

/// A control group of this test's own with a limit of memory, gone at its end.
class ControlGroup {
 public:
  explicit ControlGroup(long mebibytes) {
    std::error_code none;
    for (const auto& [mount, limit] : {std::pair("/sys/fs/cgroup/memory", "memory.limit_in_bytes"),
                                       std::pair("/sys/fs/cgroup", "memory.max")}) {
      const fs::path group = fs::path(mount) / fmt::format("luciole-test-{}-{}", getpid(), mebibytes);
      if (!fs::create_directory(group, none)) continue;
      std::ofstream limit_file(group / limit);
      limit_file << (mebibytes << 20) << std::flush;
      if (limit_file.good()) {
        path_ = group;
        return;
      }
      fs::remove(group, none);
    }
  }
  ~ControlGroup() {
    // A group goes when its last process is gone for good.
    std::error_code none;
    for (int tries = 0; tries < 100 && !path_.empty() && !fs::remove(path_, none); ++tries)
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  ControlGroup(const ControlGroup&) = delete;
  ControlGroup& operator=(const ControlGroup&) = delete;

  bool isThere() const { return !path_.empty(); }
  /// The line, in the group.
  std::string within(const std::string& line) const {
    return fmt::format("echo $$ > {}/cgroup.procs && {}", path_.string(), line);
  }

 private:
  fs::path path_;
};

TEST_F(Limits, OfAControlGroupLetTheProgramWorkOrEndInOneLine) {
  bool was_done = false, was_refused = false;
  for (const long mebibytes : {48, 96, 160, 256, 320, 400, 640}) {
    const ControlGroup group(mebibytes);
    if (!group.isThere())
      GTEST_SKIP()
          << "no control group can be made: that takes root, and a hierarchy mounted at /sys/fs/cgroup";
    for (const char* command :
         {"render scene.json --quiet -o out.png", "render scene.json --size 3000x2000 --quiet -o out.png",
          "gbuffer scene.json --size 3000x2000 --quiet -o out.exr"}) {
      const int status = expectDoneOrRefused(group.within(fmt::format("luciole {}", command)));
      was_done |= status == 0;
      was_refused |= status == 3;
    }
  }
  EXPECT_TRUE(was_done && was_refused) << "the limits tried are too small or too large to tell";
}

}  // namespace
}  // namespace luciole::test
