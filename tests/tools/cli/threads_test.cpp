// --threads, of every command that computes.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string>

#include "tools/cli/program_test.hpp"

namespace luciole::test {
namespace {

class Threads : public ProgramTest {
 protected:
  Threads() { writeText(folder / "scene.json", kSmallScene); }
};

TEST_F(Threads, ChangeNoBit) {
  succeed("luciole gbuffer scene.json --quiet -o input.exr");
  const std::vector<std::pair<const char*, const char*>> commands{
      {"render scene.json --size 200x120 --samples 2 --shadows soft --exposure auto", "npy"},
      {"render scene.json --shading gouraud", "npy"},
      {"gbuffer scene.json --size 200x120", "exr"},
      {"shade input.exr --scene scene.json --shadows exact", "npy"},
      {"reference scene.json", "npy"},
      {"generate lights scene.json --shape surface --count 50 --density 4", "json"}};
  for (std::size_t i = 0; i < commands.size(); ++i) {
    const auto& [command, extension] = commands[i];
    const bool is_picture = std::string(extension) != "json";
    for (const int threads : {1, 2, 3})
      succeed(fmt::format("luciole {} --threads {}{} -o {}.{}.{}", command, threads,
                          is_picture ? " --quiet" : "", i, threads, extension));
    for (const int threads : {2, 3}) {
      const std::string one = fmt::format("{}.1.{}", i, extension),
                        other = fmt::format("{}.{}.{}", i, threads, extension);
      if (std::string(extension) == "exr")  // which holds the time of day
        succeed(fmt::format("luciole compare {} {} --max-abs 0 --threads {}", one, other, threads));
      else
        EXPECT_EQ(readText(folder / one), readText(folder / other));
    }
  }
}

TEST_F(Threads, BoundThoseOfTheProcess) {
  for (const int threads : {1, 2, 3}) {
    succeed(fmt::format("luciole render scene.json --size 640x360 --threads {} --stats stats.json -o a.png",
                        threads));
    const auto stats = nlohmann::json::parse(readText(folder / "stats.json"));
    if (stats["device"]["platform"] != "Portable Computing Language") {
      ASSERT_EQ(std::getenv("LUCIOLE_SHARED"), nullptr) << stats["device"]["platform"];
      GTEST_SKIP() << "not PoCL, which is told its threads";
    }
    EXPECT_EQ(stats["device"]["compute_units"], threads);
    // The first one, the one that waits for signals, those that oneTBB adds, and PoCL's.
    EXPECT_LE(stats["threads"], 1 + 1 + (threads - 1) + threads);
    EXPECT_GE(stats["threads"], 1 + 1 + threads);
  }
}

TEST_F(Threads, BoundThoseThatWriteAnExrToo) {
  const auto living = [&](int threads, const std::string& picture) {
    succeed(fmt::format("luciole render scene.json --threads {} --quiet --stats stats.json -o {}", threads,
                        picture));
    return nlohmann::json::parse(readText(folder / "stats.json"))["threads"].get<int>();
  };
  for (const int threads : {1, 2, 3})
    // OpenImageIO is loaded for both, but for the one alone OpenEXR starts its threads, and OpenImageIO those
    // that it has beside its caller's.
    EXPECT_LE(living(threads, "a.exr") - living(threads, "a.jpg"), threads + (threads - 1));
}

TEST_F(Threads, AreAtLeastOneAndWhole) {
  succeed("luciole gbuffer scene.json --quiet -o g.exr");
  for (const char* command :
       {"render scene.json -o out.png", "gbuffer scene.json -o out.exr",
        "shade g.exr --scene scene.json -o out.png", "reference scene.json -o out.png", "compare g.exr g.exr",
        "bench", "scale scene.json --lights 1 -o out", "generate lights -o out.json"})
    for (const char* threads : {"0", "-1", "two", "1.5", "1025"})
      refuse(fmt::format("luciole {} --threads {}", command, threads), 2, "--threads");
}

}  // namespace
}  // namespace luciole::test
