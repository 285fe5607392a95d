// What the program says of a word that it doesn't know.
#include "tools/cli/suggest.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "tools/cli/run_program.hpp"

namespace luciole::test {
namespace {

class Misspelt : public testing::Test {
 protected:
  Misspelt() { writeText(folder / "scene.json", kSmallScene); }
  void expectSaid(const std::string& line, const std::string& said) {
    const Outcome outcome = runLine(folder, line);
    EXPECT_EQ(outcome.status, 2) << line;
    EXPECT_EQ(outcome.err, said + "\n") << line;
    EXPECT_FALSE(std::filesystem::exists(folder / "out.png")) << line;
  }
  TemporaryFolder folder;
};

TEST_F(Misspelt, OptionsGetASuggestion) {
  expectSaid("luciole render scene.json -o out.png --shadow pcf",
             "luciole render: no option --shadow; did you mean --shadows?");
  expectSaid("luciole render scene.json -o out.png --shadow=pcf",
             "luciole render: no option --shadow; did you mean --shadows?");
  expectSaid("luciole render --smples 4 scene.json -o out.png",
             "luciole render: no option --smples; did you mean --samples?");
  expectSaid("luciole render scene.json -o out.png --frobnicate 3 --shadow pcf",
             "luciole render: no option --frobnicate (see luciole help render)");
  expectSaid("luciole generate lights --cuont 3",
             "luciole generate lights: no option --cuont; did you mean --count?");
  expectSaid("luciole --verson", "luciole: no option --verson; did you mean --version?");
  expectSaid("luciole scale merge a -o b --plto c.svg",
             "luciole scale merge: no option --plto; did you mean --plot?");
}

TEST_F(Misspelt, OptionsAreToldBeforeWhatIsMissingForThem) {
  expectSaid("luciole render scene.json --outptu out.png",
             "luciole render: no option --outptu; did you mean --output?");
}

TEST_F(Misspelt, CommandsGetASuggestion) {
  expectSaid("luciole rendr scene.json -o out.png", "luciole: no command rendr; did you mean render?");
  expectSaid("luciole tset", "luciole: no command tset; did you mean test?");
  expectSaid("luciole help shad", "luciole: no command shad; did you mean shade?");
  expectSaid("luciole frobnicate", "luciole: no command frobnicate (see luciole help)");
  expectSaid("luciole generate light", "luciole generate: no command light; did you mean lights?");
}

TEST_F(Misspelt, ValuesGetASuggestion) {
  const std::string line = "luciole render scene.json -o out.png ";
  expectSaid(line + "--shadows pfc",
             "luciole: --shadows: 'pfc' is none of auto, off, hard, pcf, soft, exact, soft-exact; did you "
             "mean pcf? (see "
             "luciole help)");
  expectSaid(line + "--shading smooth",
             "luciole: --shading: 'smooth' is none of flat, gouraud, phong (see luciole help)");
  EXPECT_THAT(runLine(folder, "luciole render scene.json -o out.exr --aov norml").err,
              testing::HasSubstr("did you mean normal?"));
  EXPECT_THAT(runLine(folder, "luciole scale scene.json -o o --lights 1 --vary shdows").err,
              testing::HasSubstr("did you mean shadows?"));
}

TEST_F(Misspelt, WordsThatNothingTakesAreToldAsTyped) {
  expectSaid("luciole render scene.json -o out.png more words",
             "luciole render: 'more' is more than it takes (see luciole help render)");
}

}  // namespace
}  // namespace luciole::test
