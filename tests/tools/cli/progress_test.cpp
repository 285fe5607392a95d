// The line that says how far the work is: on a terminal, and nowhere else.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <pty.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <string>

#include "tools/cli/run_program.hpp"

namespace luciole::test {
namespace {

using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;

/// What the program writes to a terminal of its own, on which it runs in the folder, after a line of the
/// shell.
std::string runOnTerminal(const TemporaryFolder& folder, const std::string& arguments,
                          const std::string& first = "") {
  int terminal = -1;
  const std::string line =
      "cd '" + folder.path().string() + "' && " + first + "exec '" LUCIOLE_BINARY "' " + arguments;
  const pid_t child = forkpty(&terminal, nullptr, nullptr, nullptr);
  if (child == 0) {
    execl("/bin/sh", "sh", "-c", line.c_str(), static_cast<char*>(nullptr));
    _exit(127);
  }
  EXPECT_GT(child, 0);
  std::string text;
  std::array<char, 4096> buffer;
  // The read fails when the program, the terminal's last user, has ended.
  for (ssize_t n; (n = read(terminal, buffer.data(), buffer.size())) > 0;)
    text.append(buffer.data(), std::size_t(n));
  close(terminal);
  int status = -1;
  waitpid(child, &status, 0);
  EXPECT_EQ(status, 0) << text;
  return text;
}

class Progress : public testing::Test {
 protected:
  Progress() { writeText(folder / "scene.json", kSmallScene); }
  /// Whether no progress stays on the screen: each line of it is taken away before its end.
  static void expectTakenAway(const std::string& text) {
    const std::size_t last = text.rfind(" left");
    ASSERT_NE(last, std::string::npos) << text;
    EXPECT_EQ(text.substr(last + 5, 4), "\r\x1b[K") << text;
  }
  TemporaryFolder folder;
};

TEST_F(Progress, OfAPictureShowsTheTimeLeft) {
  const std::string text =
      runOnTerminal(folder, "render scene.json --samples 8 --samples-shading all -o out.png");
  EXPECT_THAT(text, ContainsRegex("out.png: 50 %, 0:[0-9][0-9] left"));
  expectTakenAway(text);
}

TEST_F(Progress, OfFramesCountsThemAndWhatIsDoneOfEach) {
  const std::string text =
      runOnTerminal(folder, "render scene.json --frames 3,5 --samples 4 --samples-shading all -o out.#.png");
  EXPECT_THAT(text, ContainsRegex("frame 5, 2 of 2: 75 %, 0:[0-9][0-9] left"));
  expectTakenAway(text);
}

TEST_F(Progress, OfTheReferenceAndOfAnExperimentShowsTheTimeLeft) {
  const std::string reference = runOnTerminal(folder, "reference scene.json -o out.exr");
  EXPECT_THAT(reference, ContainsRegex("out.exr: [0-9]+ %, 0:[0-9][0-9] left"));
  expectTakenAway(reference);
  const std::string scale = runOnTerminal(
      folder, "scale scene.json --lights 1,10 --size 32x18 --repeat 2 --check-pixels 16 -o run");
  EXPECT_THAT(scale, ContainsRegex("run 2 of 4: lights=1[^\r]* left"));
}

TEST_F(Progress, SaysThatKernelsAreCompiledWhereThatTakesLong) {
  // With an empty cache this scene's kernels take seconds.
  const auto cold = [](const std::string& name) {
    return "export POCL_CACHE_DIR=$PWD/" + name + " XDG_CACHE_HOME=$PWD/" + name + "; mkdir " + name + "; ";
  };
  const std::string line = "render scene.json --shadows off -o out.png";
  EXPECT_THAT(runOnTerminal(folder, line, cold("terminal")), HasSubstr("\r\x1b[Kcompiling kernels\r\x1b[K"));
  EXPECT_THAT(runLine(folder, cold("pipe") + "luciole " + line).err, Not(HasSubstr("compiling")));
  EXPECT_THAT(runLine(folder, cold("log") + "luciole " + line + " --log json").err,
              HasSubstr("\"what\":\"compiling kernels\"}"));
}

TEST_F(Progress, IsNotInAPipeNorWhereQuietIsAsked) {
  for (const char* line :
       {"luciole render scene.json --samples 4 -o out.png", "luciole reference scene.json -o out.exr",
        "luciole render scene.json --frames 1-2 -o out.#.png"}) {
    const std::string said = runLine(folder, line).err;
    EXPECT_THAT(said, Not(HasSubstr("left"))) << line;
    EXPECT_THAT(said, Not(HasSubstr("\r"))) << line;
  }
  EXPECT_EQ(runOnTerminal(folder, "render scene.json --quiet -o out.png"), "");
}

TEST_F(Progress, IsAnEventForEachPercentInALog) {
  const std::string text =
      runOnTerminal(folder, "render scene.json --samples 4 --samples-shading all --log json -o out.png");
  EXPECT_THAT(text, Not(HasSubstr("\x1b")));
  for (const char* percent : {"25", "50", "75", "100"})
    EXPECT_THAT(text, HasSubstr(std::string("\"what\":\"out.png\",\"percent\":") + percent + ","));
}

}  // namespace
}  // namespace luciole::test
