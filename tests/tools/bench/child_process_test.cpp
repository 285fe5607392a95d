#include "tools/bench/child_process.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "luciole/error.hpp"

namespace luciole::test {
namespace {

TEST(ChildProcess, RunsWithItsArgumentsAndEnvironmentAndTakesTime) {
  const ScratchFolder folder;
  const double milliseconds =
      runChild("/bin/sh", {"-c", "sleep 0.05; echo \"$1 $WORD\" > \"$0\"", folder / "out", "an argument"},
               {{"WORD", "a value"}});
  EXPECT_GE(milliseconds, 50);
  std::ifstream file(folder / "out");
  std::string line;
  std::getline(file, line);
  EXPECT_EQ(line, "an argument a value");
}

TEST(ChildProcess, AFailureIsAMachineErrorThatNamesTheCommand) {
  for (const auto& [script, what] :
       {std::pair("echo because >&2; exit 3", "exit status 3: because"), {"kill -9 $$", "signal 9"}}) {
    try {
      runChild("/bin/sh", {"-c", script}, {});
      FAIL() << script;
    } catch (const MachineError& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr(std::string("/bin/sh -c ") + script));
      EXPECT_THAT(error.what(), testing::HasSubstr(what));
    }
  }
  EXPECT_THROW(runChild("/none/program", {}, {}), MachineError);
}

TEST(ScratchFolder, IsGoneWithAllThatIsInItAfterAnError) {
  std::string place;
  try {
    const ScratchFolder folder;
    place = folder / "file";
    std::ofstream(place) << "text";
    EXPECT_TRUE(std::filesystem::exists(place));
    throw std::runtime_error("an error");
  } catch (const std::runtime_error&) {
  }
  EXPECT_FALSE(std::filesystem::exists(std::filesystem::path(place).parent_path()));
}

TEST(ChildProcess, ThePeakOfMemoryInItsStatisticsIsItsOwnAndNotItsParents) {
  constexpr std::size_t kMuch = std::size_t(1) << 30;  // an empty picture takes a quarter of it
  const std::vector<char> memory(kMuch, 1);
  const ScratchFolder folder;
  std::ofstream(folder / "scene.json") << "{}";
  runChild(LUCIOLE_BINARY,
           {"render", folder / "scene.json", "--size", "16x16", "--quiet", "-o", folder / "out.exr",
            "--stats", folder / "stats.json"},
           {});
  std::ifstream file(folder / "stats.json");
  const std::size_t peak = nlohmann::json::parse(file)["memory"]["peak_bytes"];
  EXPECT_GT(peak, 0u);
  EXPECT_LT(peak, kMuch) << memory.size();
}

}  // namespace
}  // namespace luciole::test
