// devices --check, and what pictures do on a device that computes otherwise.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "luciole/image.hpp"
#include "tools/cli/program_test.hpp"

namespace luciole::test {
namespace {

using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;

class CheckedDevices : public ProgramTest {
 protected:
  CheckedDevices() { writeText(folder / "scene.json", kSmallScene); }

  /// Begins a line whose program remembers nothing of devices but what it looks up here.
  const std::string own_cache = "export XDG_CACHE_HOME=$PWD/cache; ";

  /// Makes the program believe that the default device computes otherwise.
  void spoilDevice() {
    succeed(own_cache + "luciole render scene.json --quiet -o a.exr");
    for (const auto& kept : std::filesystem::directory_iterator(folder / "cache/luciole/checks"))
      writeText(kept.path(), readText(kept.path()) + "a / b of 1 gives 2, not 3\n");
  }
};

TEST_F(CheckedDevices, EachIsToldToHaveTheSameBits) {
  const std::string told = succeed("luciole devices --check");
  EXPECT_THAT(told, HasSubstr("     bits: same, "));
  EXPECT_THAT(told, Not(HasSubstr("different")));
  EXPECT_THAT(succeed("luciole devices"), Not(HasSubstr("bits")));
  for (const char* lanes : {"1", "4", "8", "16"})
    EXPECT_THAT(succeed(std::string("luciole devices --check --device ,lanes=") + lanes),
                HasSubstr("bits: same"));
}

TEST_F(CheckedDevices, APictureTellsTheHashOfTheArithmetic) {
  const Outcome outcome = run("luciole render scene.json --log json --stats stats.json -o a.exr");
  const std::string hash = nlohmann::json::parse(readText(folder / "stats.json"))["device"]["arithmetic"];
  EXPECT_EQ(hash.size(), 64u);
  EXPECT_THAT(outcome.err, HasSubstr("\"arithmetic\":\"" + hash + "\""));
  EXPECT_EQ(readAttribute(folder / "a.exr", "luciole:arithmetic"), hash);
  EXPECT_THAT(succeed("luciole devices --check"), HasSubstr("arithmetic " + hash.substr(0, 16)));
  succeed("luciole render scene.json --require-exact --quiet -o b.exr");
}

TEST_F(CheckedDevices, OneThatDiffersRendersWithAWarningUnlessExactnessIsRequired) {
  spoilDevice();
  const std::string told = this->told(own_cache + "luciole render scene.json --frames 1-2 -o a.#.exr");
  EXPECT_THAT(told, ContainsRegex("warning: .*other bits.*a / b of 1 gives 2, not 3"));
  EXPECT_EQ(told.find("a / b"), told.rfind("a / b")) << "once, not a frame\n" << told;
  EXPECT_EQ(this->told(own_cache + "luciole render scene.json --quiet -o b.exr"), "");
  refuse(own_cache + "luciole render scene.json --require-exact --quiet -o c.exr", 3, "--require-exact: ");
  refuse(own_cache + "luciole render scene.json --require-exact --quiet --frames 1-2 -o c.#.exr", 3,
         "a / b of 1");
  succeed("luciole gbuffer scene.json --quiet -o g.exr");
  refuse(own_cache + "luciole shade g.exr --scene scene.json --require-exact --quiet -o c.exr", 3,
         "a / b of 1");
  refuse(own_cache + "luciole relight g.exr --lights scene.json --require-exact --quiet -o c.exr", 3,
         "a / b of 1");
  EXPECT_EQ(filesIn(folder), (std::vector<std::string>{"a.1.exr", "a.2.exr", "a.exr", "b.exr", "cache",
                                                       "g.exr", "scene.json"}));
}

// Another compiler, and no vector instructions. At 1 and 16 lanes pictures do the same with --require-exact:
// SceneHashesUnderOclgrind.
TEST_F(CheckedDevices, HaveTheSameBitsUnderOclgrind) {
  LUCIOLE_NEEDS_PROGRAM("oclgrind", "oclgrind");
  EXPECT_THAT(underOclgrind("devices --check --device ,lanes=8"), HasSubstr("bits: same"));
}

// A device whose compiler makes another sum of one line of the kernels (mutate_kernels.c).
TEST_F(CheckedDevices, OneThatDiffersIsToldWithTheOperation) {
  LUCIOLE_NEEDS_PROGRAM("cc", "gcc");
  succeed("cc -shared -fPIC -o device.so '" LUCIOLE_SOURCE_DIR "/tests/mutate_kernels.c' -ldl");
  const std::string quotients = readText(LUCIOLE_SOURCE_DIR "/kernels/quotient.clh");
  const std::string line = "INLINE float square_root(float a) { return sqrt(a); }";
  const auto number =
      1 + std::count(quotients.begin(), quotients.begin() + std::ptrdiff_t(quotients.find(line)), '\n');
  const Outcome outcome =
      runLine(folder, "export MUTANT_FILE=kernels/quotient.clh MUTANT_LINE=" + std::to_string(number) +
                          " MUTANT_OLD='" + line +
                          "' MUTANT_NEW='INLINE float square_root(float a) { return sqrt(a) * 1.0000001f; }' "
                          "MUTANT_LOG=$PWD/log LD_PRELOAD=$PWD/device.so; luciole devices --check");
  EXPECT_EQ(outcome.status, 1) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("bits: different"));
  EXPECT_THAT(outcome.out, ContainsRegex("\n       square root of a of a = .* gives .*, not "));
}

}  // namespace
}  // namespace luciole::test
