// luciole scale --against: the pictures of other methods.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

#include "luciole/compare.hpp"
#include "luciole/image.hpp"
#include "tools/cli/run_program.hpp"
#include "tools/cli/scale_command.hpp"

namespace luciole::test {
namespace {

using testing::HasSubstr;

/// Experiments by a list of 10 lights that stay as they are.
class ScaleAgainst : public ScaleCommand {
 protected:
  ScaleAgainst() {
    std::string list;
    for (int i = 0; i < 10; ++i)
      list += std::to_string(i % 5 - 2) + ",1.5," + std::to_string(i / 5) + ",1,0.5,0.2,3\n";
    writeText(folder / "own.csv", list);
  }
  /// The picture that luciole render makes of the first lights.
  void renderLights(int count, const std::string& file) {
    auto scene = nlohmann::json::parse(readText(folder / "scene.json"), nullptr, true, true);
    scene.erase("lights");
    scene["light_fields"] = nlohmann::json::array({nlohmann::json{{"csv", "own.csv"}, {"count", count}}});
    writeText(folder / "lit.json", scene.dump());
    ASSERT_EQ(runLine(folder, "luciole render lit.json --size 48x27 --shadows off --quiet -o " + file).status,
              0);
  }
  const std::string own = "--field own.csv --own-lights --lights 2,10 ";
};

TEST_F(ScaleAgainst, FilesAreHeldAgainstTheSameTruthAtTheSamePixels) {
  renderLights(2, "theirs-2.exr");
  renderLights(10, "theirs-10.exr");
  writeText(folder / "times.csv", "lights,milliseconds\n2, 0.001\r\n\n10,1e6\n");
  succeed(own +
          "--exposure 1 --vary culling --against 'theirs=theirs-{lights}.exr,ms=times.csv' "
          "--against same=theirs-{lights}.exr --repeat 3 -o run --plot plot.svg");
  const std::vector<Row> rows = readCsv(folder / "run/results.csv");
  ASSERT_EQ(rows.size(), 2u * 4);
  for (std::size_t i = 0; i < rows.size(); i += 4) {
    const Row &ours = rows[i], &theirs = rows[i + 2], &same = rows[i + 3];
    EXPECT_EQ(ours.at("method"), "luciole");
    EXPECT_EQ(theirs.at("method"), "theirs");
    EXPECT_EQ(theirs.at("culling"), "-");
    // The picture that Luciole makes, exposed as its own: the same errors.
    for (const auto& [name, figure] : kImageMetrics) EXPECT_EQ(theirs.at(name), ours.at(name)) << name;
    EXPECT_EQ(readImage(folder / ("run/" + theirs.at("picture"))).pixels,
              readImage(folder / ("run/" + ours.at("picture"))).pixels);
    EXPECT_EQ(theirs.at("checked_pixels"), ours.at("checked_pixels"));
    EXPECT_EQ(theirs.at("runs"), "1");
    EXPECT_EQ(theirs.at("shade_ms"), "");
    EXPECT_EQ(theirs.at("list_map"), "");
    EXPECT_EQ(same.at("mean_abs"), ours.at("mean_abs"));
    EXPECT_EQ(same.at("runs"), "0");
    EXPECT_EQ(same.at("ms"), "");
    EXPECT_EQ(same.at("front"), "0");
    EXPECT_EQ(ours.at("times_first"), "");
    EXPECT_GT(std::stod(rows[i + 1].at("times_first")), 0);
    EXPECT_LE(std::stod(rows[i + 1].at("times_first_low")), std::stod(rows[i + 1].at("times_first_high")));
  }
  EXPECT_EQ(rows[2].at("ms"), "0.001");
  EXPECT_EQ(rows[2].at("front"), "1");
  EXPECT_LT(std::stod(rows[2].at("times_first")), 0.01);
  EXPECT_EQ(rows[6].at("front"), "0");
  EXPECT_THAT(readText(folder / "plot.svg"), HasSubstr(">theirs"));
  EXPECT_THAT(readText(folder / "run/report.html"), HasSubstr("\"method\":\"theirs\""));
  // Done again nothing is to do; with another picture it is another experiment.
  const std::string log = readText(folder / "run/results.jsonl");
  succeed(own +
          "--exposure 1 --vary culling --against 'theirs=theirs-{lights}.exr,ms=times.csv' "
          "--against same=theirs-{lights}.exr --repeat 3 -o run");
  EXPECT_EQ(readText(folder / "run/results.jsonl"), log);
  renderLights(2, "theirs-10.exr");
  EXPECT_THAT(refuse(own + "--exposure 1 --vary culling --against 'theirs=theirs-{lights}.exr,ms=times.csv' "
                           "--against same=theirs-{lights}.exr --repeat 3 -o run"),
              HasSubstr("against theirs's SHA-256"));
}

TEST_F(ScaleAgainst, APictureThatIsNotThereIsToldAndItsPointLeftOut) {
  renderLights(10, "theirs-10.exr");
  const Outcome outcome = scale(own + "--against theirs=theirs-{lights}.exr,ms=5 --repeat 1 -o run");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.err, "luciole: against theirs: theirs-2.exr is not there, so its point is left out\n");
  const std::vector<Row> rows = readCsv(folder / "run/results.csv");
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[2].at("ms"), "5");
}

TEST_F(ScaleAgainst, WhatIsWrongWithAMethodIsToldBeforeAnythingIsMeasured) {
  renderLights(10, "t-10.exr");
  renderLights(2, "t-2.exr");
  writeImage({2, 2, {"R", "G", "B"}, std::vector<float>(12)}, folder / "small.npy", {});
  writeImage({48, 27, {"R", "G", "B"}, std::vector<float>(48 * 27 * 3, NAN)}, folder / "nan.npy", {});
  writeText(folder / "some.csv", "2,1\n");
  writeText(folder / "twice.csv", "2,1\n10,1\n2,1\n");
  writeText(folder / "odd.csv", "lights,milliseconds\n2,fast\n");
  for (const auto& [against, said] : std::initializer_list<std::pair<const char*, const char*>>{
           {"t-{lights}.exr", "expected NAME=PICTURES"},
           {"=t-{lights}.exr", "expected NAME=PICTURES"},
           {"luciole=t-{lights}.exr", "a name other than luciole"},
           {"a=", "expected the name of a picture"},
           {"a=t-10.exr", "expected {lights} in the name, for there are 2 numbers of lights"},
           {"a=u-{lights}.exr", "u-2.exr: there is no such picture"},
           {"a=small.npy{lights}", "there is no such picture"},
           {"a=t-{lights}.exr,ms=0", "ms=0: expected milliseconds above 0"},
           {"a=t-{lights}.exr,ms=nan", "ms=nan: expected milliseconds above 0"},
           {"a=t-{lights}.exr,ms=", "after ms="},
           {"a=t-{lights}.exr,ms=none.csv", "none.csv"},
           {"a=t-{lights}.exr,ms=some.csv", "some.csv: no time of 10 lights, of which a has a picture"},
           {"a=t-{lights}.exr,ms=twice.csv", "twice.csv: line 3: 2 lights are there twice"},
           {"a=t-{lights}.exr,ms=odd.csv", "odd.csv: line 2: expected lights,milliseconds, got \"2,fast\""},
           {"a=-,ms=3", "are timed; expected no ms"},
           {"a=t-{lights}.exr --against a=-", "the name is there twice"},
           {"a=t-{lights}.exr --vary shadows=off,exact", "meant to make different pictures"},
           {"a=- --set ambient=1", "--set"}}) {
    EXPECT_THAT(refuse(own + "--against " + against + " -o run"), HasSubstr(said)) << against;
    EXPECT_FALSE(std::filesystem::exists(folder / "run")) << against;
  }
  const std::string one = "--field own.csv --own-lights --lights 2 -o run --against a=";
  EXPECT_THAT(refuse(one + "small.npy"), HasSubstr("small.npy: 2 x 2 pixels, expected 48 x 27"));
  EXPECT_THAT(refuse(one + "nan.npy"), HasSubstr("nan.npy: 3888 values are not finite"));
  EXPECT_FALSE(std::filesystem::exists(folder / "run"));
}

/// What answers questions, a shell's function of one question after another: it has $question, $method,
/// $round, $lights, $scene and $output.
std::string answering(const std::string& how) {
  return R"sh(answer() { while IFS= read -r question; do
  printf '%s\n' "$question" >>questions
  for key in method scene output; do eval "$key=$(printf '%s' "$question" | sed "s/.*\"$key\":\(\"[^\"]*\"\).*/\1/")"; done
  for key in lights round; do eval "$key=$(printf '%s' "$question" | sed "s/.*\"$key\":\([0-9]*\).*/\1/")"; done
  )sh" + how +
         R"sh(
done; }
mkfifo answers
)sh";
}

/// The same, and an experiment that asks it. Its status, and a listing of temporary folders, go to files.
std::string asking(const std::string& arguments, const std::string& how) {
  return answering(how) +
         "mkdir -p tmp; export TMPDIR=$PWD/tmp; { luciole scale scene.json --size 48x27 --check-pixels 40 " +
         arguments + " <answers; echo $? >status; } | answer >answers; ls tmp >left; rm answers";
}

constexpr const char* kRendering = "[ $round = 0 ] && '" LUCIOLE_BINARY
                                   "' render $scene --size 48x27 --shadows off --quiet -o $output; echo "
                                   "\"{\\\"milliseconds\\\": $((round + lights))}\"";

TEST_F(ScaleAgainst, PicturesAreAskedForInTheRoundsOfItsOwnOnes) {
  size = "48x27";
  // A field of its own whose ranges are chosen, so that the scene must have those, and another camera.
  const Outcome outcome = runLine(
      folder, asking("--lights 3,200 --vary culling --against mine=- --against yours=- --repeat 3 -o run",
                     kRendering));
  EXPECT_EQ(readText(folder / "status"), "0\n") << outcome.err;
  EXPECT_EQ(outcome.err, "");
  EXPECT_EQ(readText(folder / "left"), "") << "the scenes are gone";
  // Nothing else was on standard output.
  std::vector<std::string> order;
  for (const std::string& line : linesOf(folder / "questions")) {
    const auto question = nlohmann::json::parse(line);
    EXPECT_EQ(question["size"], (nlohmann::json{48, 27}));
    EXPECT_EQ(question["frame"], 1);
    order.push_back(std::to_string(question["round"].get<int>()) + " " +
                    question["method"].get<std::string>() + " " +
                    std::to_string(question["lights"].get<int>()));
  }
  ASSERT_EQ(order.size(), 4u * (1 + 3));
  EXPECT_EQ(std::set<std::string>(order.begin(), order.end()).size(), order.size());
  EXPECT_TRUE(std::is_sorted(order.begin(), order.end(), [](const std::string& a, const std::string& b) {
    return a[0] < b[0];
  })) << "in rounds";
  const std::vector<Row> rows = readCsv(folder / "run/results.csv");
  ASSERT_EQ(rows.size(), 2u * 4);
  for (std::size_t i = 0; i < rows.size(); i += 4)
    for (std::size_t k = 2; k < 4; ++k) {
      // Of the same lights to the bit, so it is the same picture.
      for (const auto& [name, figure] : kImageMetrics)
        EXPECT_EQ(rows[i + k].at(name), rows[i].at(name)) << name;
      EXPECT_EQ(rows[i + k].at("runs"), "3");
      EXPECT_EQ(std::stod(rows[i + k].at("ms")), std::stod(rows[i].at("lights")) + 2) << "rounds 1, 2 and 3";
      EXPECT_FALSE(rows[i + k].at("times_first_low").empty());
    }
}

TEST_F(ScaleAgainst, AMethodThatCannotMakeAPictureLacksThatPointAlone) {
  const Outcome outcome = runLine(
      folder,
      asking(own + "--against mine=- --repeat 1 -o run",
             std::string(
                 "[ $lights = 10 ] && { printf '%s\\n' '{\"error\": \"too many\\nlights\"}'; continue; }; ") +
                 kRendering));
  EXPECT_EQ(readText(folder / "status"), "0\n");
  EXPECT_THAT(outcome.err, HasSubstr("luciole: lights=10 method=mine: too many lights\n"));
  EXPECT_EQ(readCsv(folder / "run/results.csv").size(), 3u);
  // And one whose picture is none.
  const Outcome wrong =
      runLine(folder, asking(own + "--against mine=- --repeat 1 -o wrong", "echo '{\"milliseconds\": 1}'"));
  EXPECT_EQ(readText(folder / "status"), "0\n");
  EXPECT_THAT(wrong.err, HasSubstr("luciole: lights=2 method=mine: "));
  EXPECT_THAT(wrong.err, HasSubstr("picture.npy"));
  EXPECT_EQ(readCsv(folder / "wrong/results.csv").size(), 2u);
}

TEST_F(ScaleAgainst, WhereNobodyAnswersTheExperimentEndsAndGoesOnLater) {
  const std::string arguments = own + "--against mine=- --repeat 2 -o run";
  // One answer, and then no more.
  const Outcome outcome = runLine(folder, asking(arguments, std::string(kRendering) + "; break"));
  EXPECT_EQ(readText(folder / "status"), "2\n");
  EXPECT_TRUE(isOneLine(outcome.err)) << outcome.err;
  EXPECT_THAT(
      outcome.err,
      testing::AnyOf(HasSubstr("standard input: ended, expected an answer about mine by 10 lights, round 0"),
                     HasSubstr("standard output: nobody reads the question about mine by 10 lights")));
  EXPECT_EQ(readText(folder / "left"), "");
  const std::vector<std::string> before = linesOf(folder / "run/results.jsonl");
  runLine(folder, asking(arguments, kRendering));
  EXPECT_EQ(readText(folder / "status"), "0\n");
  const std::vector<std::string> after = linesOf(folder / "run/results.jsonl");
  EXPECT_TRUE(std::equal(before.begin(), before.end(), after.begin()));
  EXPECT_EQ(after.size(), 2 + 4u * (1 + 2));

  EXPECT_THAT(refuse(own + "--against mine=- --repeat 1 -o a"), HasSubstr("standard input: ended"));
  EXPECT_THAT(refuse(own + "--against mine=- --repeat 1 -o b >/dev/full"), HasSubstr("nobody reads"));
  for (const char* answer :
       {"", "5", "{}", "{\"milliseconds\": \"fast\"}", "{\"milliseconds\": -1}", "{\"milliseconds\": 1e999}",
        "{\"milliseconds\": 1", "{\"error\": 5}", "[\"error\"]"}) {
    writeText(folder / "answer", std::string(answer) + "\n");
    EXPECT_THAT(refuse(own + "--against mine=- --repeat 1 -o c <answer"),
                HasSubstr("standard input: line 1: expected"))
        << answer;
  }
  // Longer than any answer.
  EXPECT_THAT(refuse(own + "--against mine=- --repeat 1 -o d </dev/zero"),
              HasSubstr("standard input: line 1: expected"));
}

}  // namespace
}  // namespace luciole::test
