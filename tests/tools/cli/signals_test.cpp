// What a signal leaves of a run: its status, the end of its event log, and no file that isn't whole.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tools/cli/program_test.hpp"

namespace luciole::test {
namespace {

using testing::EndsWith;
using testing::HasSubstr;

class Signals : public ProgramTest {
 protected:
  Signals() { writeText(folder / "scene.json", kSmallScene); }

  /// Runs the program until its log, which is left in `log`, has the event; then sends it the signal.
  /// launcher: what starts it. What runs in the background ignores SIGINT, and so do all that it starts.
  Outcome stop(const std::string& signal, const std::string& arguments, const std::string& event,
               const std::string& launcher = "env --default-signal=HUP,INT,TERM") {
    return runLine(
        folder,
        fmt::format(
            "rm -f log; (exec {} '" LUCIOLE_BINARY
            "' {} --log json 2>log) & until grep -q '\"{}\"' log || ! kill -0 $!; do sleep 0.01; done; "
            "kill -{} $!; wait $!",
            launcher, arguments, event, signal));
  }
  nlohmann::json lastEvent() {
    const std::string log = readText(folder / "log");
    const auto begin = log.rfind('\n', log.size() - 2);
    return nlohmann::json::parse(log.substr(begin + 1));
  }
  /// Names of all files but the scene's and the log's.
  std::vector<std::string> files() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
      if (const std::string name = entry.path().filename(); name != "scene.json" && name != "log")
        names.push_back(name);
    return names;
  }
};

TEST_F(Signals, EndTheLogWithTheStatusThatShellsKnow) {
  for (const auto& [signal, status] : {std::pair("TERM", 143), {"INT", 130}, {"HUP", 129}}) {
    const std::string arguments = "render scene.json --frames 1-100000 --size 320x180 -o f.####.png";
    const Outcome outcome = stop(signal, arguments, "frame_done");
    EXPECT_EQ(outcome.status, status) << signal;
    EXPECT_EQ(lastEvent()["event"], "end") << signal;
    EXPECT_EQ(lastEvent()["status"], status) << signal;
    EXPECT_THAT(readText(folder / "log"),
                HasSubstr(fmt::format(R"("message":"ended by SIG{}","status":{})", signal, status)));
    for (const std::string& name : files()) {
      EXPECT_THAT(name, EndsWith(".png"));
      EXPECT_EQ(readText(folder / name).substr(1, 3), "PNG");
      EXPECT_THAT(readText(folder / name), HasSubstr("IEND")) << name;
      std::filesystem::remove(folder / name);
    }
  }
}

TEST_F(Signals, EndAtOnceWhatComputesLong) {
  // Every light on each of 33 million pixels would take minutes.
  EXPECT_EQ(stop("TERM", "reference scene.json --size 7680x4320 -o big.exr", "loaded").status, 143);
  std::filesystem::create_directory(folder / "cache");
  EXPECT_EQ(
      stop("TERM", "render scene.json --size 64x36 -o cold.png", "loaded", "env POCL_CACHE_DIR=$PWD/cache")
          .status,
      143);
  std::filesystem::remove_all(folder / "cache");
  EXPECT_TRUE(files().empty());
}

TEST_F(Signals, AreTextWithoutALog) {
  const Outcome outcome =
      runLine(folder, "(exec '" LUCIOLE_BINARY
                      "' render scene.json --frames 1-100000 -o f.####.png --quiet) & "
                      "until [ -e f.0001.png ] || ! kill -0 $!; do sleep 0.01; done; kill $!; wait $!");
  EXPECT_EQ(outcome.status, 143);
  EXPECT_EQ(outcome.err, "luciole: ended by SIGTERM\n");
}

TEST_F(Signals, ThatAreIgnoredStayIgnored) {
  const Outcome outcome = stop("HUP", "render scene.json --frames 1-5 --size 320x180 -o f.####.png",
                               "frame_begun", "env --ignore-signal=HUP");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(lastEvent()["status"], 0);
  EXPECT_EQ(files().size(), 5u);
}

}  // namespace
}  // namespace luciole::test
