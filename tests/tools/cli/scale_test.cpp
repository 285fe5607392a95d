// luciole scale as a person types it, on a picture of few pixels.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "luciole/image.hpp"
#include "tools/cli/run_program.hpp"
#include "tools/cli/scale_command.hpp"

namespace luciole::test {
namespace {

using testing::HasSubstr;

TEST_F(ScaleCommand, MeasuresAndChecksEveryCombinationOnce) {
  const Outcome outcome = scale("--lights 1,10,...,1000 --vary culling,tile=4,16 --repeat 2 -o run");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");  // no progress line but on a terminal
  EXPECT_THAT(outcome.out, HasSubstr("mean error"));
  const std::vector<Row> rows = readCsv(folder / "run/results.csv");
  // Without culling there are no tiles, so their size is tried but once.
  ASSERT_EQ(rows.size(), 4u * 3);
  const std::vector<std::string> lines = linesOf(folder / "run/results.jsonl");
  EXPECT_EQ(lines.size(), 2 + 12u * (1 + 2));
  EXPECT_EQ(std::set<std::string>(lines.begin(), lines.end()).size(), lines.size());

  for (std::size_t i = 0; i < rows.size(); i += 3) {
    const Row& none = rows[i];
    EXPECT_EQ(none.at("lights"), std::to_string(std::lround(std::pow(10, i / 3))));
    EXPECT_EQ(none.at("culling"), "none");
    const std::string picture = readText(folder / ("run/" + none.at("picture")));
    ASSERT_FALSE(picture.empty());
    for (std::size_t k = 0; k < 3; ++k) {
      const Row& row = rows[i + k];
      // Culling changes no bit of the picture and none of what is in range.
      EXPECT_EQ(readText(folder / ("run/" + row.at("picture"))), picture);
      EXPECT_EQ(row.at("mean_abs"), none.at("mean_abs"));
      EXPECT_EQ(row.at("pairs_in_range"), none.at("pairs_in_range"));
      EXPECT_LE(std::stod(row.at("pairs_in_range")), std::stod(row.at("pairs_evaluated")));
      EXPECT_LE(std::stod(row.at("pairs_evaluated")), std::stod(none.at("pairs_evaluated")));
      EXPECT_EQ(row.at("runs"), "2");
      EXPECT_GT(std::stod(row.at("ms")), 0);
      EXPECT_GT(std::stod(row.at("shade_ms")), 0);
      EXPECT_GE(std::stod(row.at("peak_bytes")), 1 << 20);
      // A cell of 5 x 5 pixels each, those at the right and lower edge smaller.
      EXPECT_EQ(row.at("checked_pixels"), "60");
      // Right to a quarter of an 8-bit step, and not more right than float is.
      EXPECT_LT(std::stod(row.at("max_abs")), 0.25 / 255);
      EXPECT_GT(std::stod(row.at("max_abs")), 0);
      // Shares are of values that are 0.01 more at least, and no difference is larger than the largest.
      EXPECT_GT(std::stod(row.at("relmse")), 0);
      EXPECT_LT(std::stod(row.at("relmse")), std::pow(std::stod(row.at("max_abs")) / 0.1, 2));
      EXPECT_GT(std::stod(row.at("smape")), 0);
      EXPECT_LT(std::stod(row.at("smape")), 2 * std::stod(row.at("mean_abs")) / 0.01);
      for (const char* file : {"error_map", "list_map"})
        EXPECT_EQ(readImage(folder / ("run/" + row.at(file))).width, 480);
    }
  }
  const auto growth = nlohmann::json::parse(readText(folder / "run/growth.json"));
  EXPECT_EQ(growth["machines"].size(), 1u);
  EXPECT_FALSE(growth["machines"][0]["processor"].get<std::string>().empty());
  EXPECT_FALSE(growth["growth"].empty());
  EXPECT_THAT(readText(folder / "run/report.html"), HasSubstr("scene.json"));
}

TEST_F(ScaleCommand, LightsInRangeAreAsManyAsTheDensityAsksFor) {
  succeed("--lights 100,1000 --vary density=2,20 --repeat 1 -o run");
  for (const Row& row : readCsv(folder / "run/results.csv")) {
    const double mean = std::stod(row.at("pairs_in_range")) / std::stod(row.at("pixels_lit"));
    // All lit pixels are among the 1000 that the range is chosen at: the mean is the density, but for the
    // pair that lies at the very range, and as much as rounding to float may take or add, one more.
    EXPECT_NEAR(mean, std::stod(row.at("density")), 2.0 / std::stod(row.at("pixels_lit")))
        << row.at("lights") << " lights";
  }
}

TEST_F(ScaleCommand, InterruptedAndResumedRunEqualsAnUninterruptedOne) {
  const std::string arguments = "--lights 1,10,100 --vary culling --repeat 20 -o ";
  succeed(arguments + "whole");
  // Killed while it checks, whatever it does then, and once more while it times.
  std::vector<std::string> before;
  for (const std::size_t results : {8u, 40u}) {
    // The program itself, as the function that runLine makes would run in a shell of its own.
    const Outcome killed = runLine(
        folder,
        "'" LUCIOLE_BINARY "' scale scene.json --size 48x27 --check-pixels 40 " + arguments +
            "parts & running=$!; while kill -0 $running 2>&-; do if [ $(cat parts/results.jsonl 2>&- | "
            "wc -l) -ge " +
            std::to_string(results) + " ]; then kill -9 $running; break; fi; done; wait $running");
    ASSERT_EQ(killed.status, 128 + SIGKILL) << killed.err;
    const std::vector<std::string> now = linesOf(folder / "parts/results.jsonl");
    ASSERT_GE(now.size(), results);
    ASSERT_TRUE(std::equal(before.begin(), before.end(), now.begin()));
    before = now;
  }
  // And in the middle of a line, as a full disk or a lost machine would leave it.
  writeText(folder / "parts/results.jsonl", readText(folder / "parts/results.jsonl") + "{\"point\": \"li");
  succeed(arguments + "parts");
  const std::vector<std::string> lines = linesOf(folder / "parts/results.jsonl");
  EXPECT_TRUE(std::equal(before.begin(), before.end(), lines.begin()));
  EXPECT_EQ(lines.size(), 2 + 6u * (1 + 20));  // nothing lost, nothing done again
  EXPECT_EQ(withoutTimes(readCsv(folder / "parts/results.csv")),
            withoutTimes(readCsv(folder / "whole/results.csv")));
  for (const Row& row : readCsv(folder / "whole/results.csv"))
    for (const char* file : {"picture", "error_map", "list_map"})
      EXPECT_EQ(readText(folder / ("parts/" + row.at(file))), readText(folder / ("whole/" + row.at(file))));
  // Done a third time, nothing is left to do.
  succeed(arguments + "parts");
  EXPECT_EQ(linesOf(folder / "parts/results.jsonl"), lines);
}

TEST_F(ScaleCommand, MergedShardsEqualOneRun) {
  const std::string arguments = "--lights 1,10,100 --vary culling --repeat 2 ";
  succeed(arguments + "-o whole");
  succeed(arguments + "--shard 1/2 -o one");
  const Outcome second = runLine(folder,
                                 "export SLURM_ARRAY_TASK_ID=7 SLURM_ARRAY_TASK_MIN=6 SLURM_ARRAY_TASK_MAX=7 "
                                 "SLURM_ARRAY_TASK_COUNT=2 SLURM_ARRAY_TASK_STEP=1; luciole scale scene.json "
                                 "--size 48x27 --check-pixels 40 " +
                                     arguments + "-o two");
  ASSERT_EQ(second.status, 0) << second.err;
  EXPECT_THAT(second.err, HasSubstr("shard 2/2"));
  EXPECT_THAT(second.err, HasSubstr("two: 3 of 6 points are done; luciole scale merge"));
  const Outcome merged = runLine(folder, "luciole scale merge one two -o all");
  ASSERT_EQ(merged.status, 0) << merged.err;
  EXPECT_EQ(withoutTimes(readCsv(folder / "all/results.csv")),
            withoutTimes(readCsv(folder / "whole/results.csv")));
  for (const Row& row : readCsv(folder / "whole/results.csv"))
    EXPECT_EQ(readText(folder / ("all/" + row.at("picture"))),
              readText(folder / ("whole/" + row.at("picture"))));
  // Not even the plot needs another program.
  const Outcome plotted =
      runLine(folder, "PATH=/none luciole scale merge one two -o plotted --plot plot.svg");
  EXPECT_EQ(plotted.status, 0) << plotted.err;
  EXPECT_THAT(readText(folder / "plot.svg"), HasSubstr("</svg>"));
  EXPECT_EQ(runLine(folder, "luciole scale merge one one -o twice").status, 2);
  EXPECT_EQ(runLine(folder, "luciole scale merge one two -o all").status, 2);
  EXPECT_FALSE(std::filesystem::exists(folder / "twice"));
}

TEST_F(ScaleCommand, MergeOfSomeShardsWritesThemNamesWhatIsMissingAndEndsWithOne) {
  succeed("--lights 1,10,100 --vary culling --repeat 1 --shard 1/2 -o one");
  const Outcome merged = runLine(folder, "luciole scale merge one -o all");
  EXPECT_EQ(merged.status, 1);
  EXPECT_TRUE(isOneLine(merged.err)) << merged.err;
  EXPECT_EQ(merged.err,
            "luciole: all: 3 of 6 points are not complete: lights=1 culling=tiles; lights=10 culling=tiles; "
            "lights=100 culling=tiles\n");
  EXPECT_EQ(readCsv(folder / "all/results.csv").size(), 3u);
  EXPECT_TRUE(std::filesystem::exists(folder / "all/report.html"));
}

TEST_F(ScaleCommand, ShardWithoutAnyPointLeavesNothingToMergeAndNoError) {
  succeed("--lights 1 --repeat 1 --shard 1/2 -o one");
  succeed("--lights 1 --repeat 1 --shard 2/2 -o two --plot two.svg");
  EXPECT_TRUE(readCsv(folder / "two/results.csv").empty());
  EXPECT_FALSE(std::filesystem::exists(folder / "two.svg"));
  const Outcome merged = runLine(folder, "luciole scale merge one two -o all");
  EXPECT_EQ(merged.status, 0) << merged.err;
  EXPECT_EQ(readCsv(folder / "all/results.csv").size(), 1u);
}

TEST_F(ScaleCommand, WaysToSayHowFarLightsReachTakeTurns) {
  succeed("--lights 50 --vary range,density=2,4,tile=4,8 --repeat 1 -o run");
  const std::vector<Row> rows = readCsv(folder / "run/results.csv");
  ASSERT_EQ(rows.size(), (3u + 2) * 2);
  std::set<double> reaches;
  for (const Row& row : rows) {
    EXPECT_NE(row.at("range") == "-", row.at("density") == "-");
    reaches.insert(std::stod(row.at("reach")));
  }
  EXPECT_EQ(reaches.size(), 5u);
}

/// kSmallScene with matte surfaces, seen so narrowly that clusters pay in small pictures.
std::string matteScene() {
  std::string scene = kSmallScene;
  const auto replace = [&](const std::string& from, const std::string& to) {
    scene.replace(scene.find(from), from.size(), to);
  };
  replace("\"specular\": 0.5", "\"specular\": 0");
  replace("\"target\"", "\"fov_y\": 15, \"target\"");
  return scene;
}

TEST_F(ScaleCommand, LightErrorsAreHeldAgainstOneTruthWithinTheirBounds) {
  writeText(folder / "scene.json", matteScene());
  size = "240x135";
  succeed(
      "--lights 3000,6000 --vary light-error=0,1/16,1/256 --exposure 0.5 --repeat 1 -o run --plot plot.svg");
  const std::vector<Row> rows = readCsv(folder / "run/results.csv");
  ASSERT_EQ(rows.size(), 6u);
  for (const Row& row : rows) {
    EXPECT_EQ(row.at("reach"), "inf") << "light errors are of lights without range";
    EXPECT_EQ(row.at("truth"), "");
    const bool is_exact = row.at("light-error") == "0";
    EXPECT_EQ(row.at("max_bound").empty(), is_exact);
    EXPECT_EQ(row.at("bound_map").empty(), is_exact);
    if (is_exact) continue;
    const double promised = row.at("light-error") == "1/16" ? 1.0 / 16 : 1.0 / 256;
    EXPECT_LE(std::stod(row.at("max_bound")), 1.000001 * promised);  // a float's rounding more
    EXPECT_GT(std::stod(row.at("max_bound")), promised / 4);
    EXPECT_LT(std::stod(row.at("mean_bound")), std::stod(row.at("max_bound")));
    EXPECT_GT(std::stod(row.at("max_error")), 0);
    EXPECT_LE(std::stod(row.at("max_used")), 1);
    EXPECT_GT(std::stod(row.at("bounded_values")), 60);
    EXPECT_EQ(row.at("violations"), "0");
    EXPECT_GT(std::stod(row.at("pairs_evaluated")), 0);
    EXPECT_EQ(row.at("pairs_in_range"), rows[row.at("lights") == "3000" ? 0 : 3].at("pairs_in_range"));
    EXPECT_EQ(readImage(folder / ("run/" + row.at("bound_map"))).width, 480);
  }
  EXPECT_LT(std::stod(rows[2].at("mean_abs")), std::stod(rows[1].at("mean_abs")));
  EXPECT_THAT(readText(folder / "plot.svg"), HasSubstr(">true error<"));
  EXPECT_THAT(readText(folder / "run/results.jsonl"), HasSubstr(R"("no-range":"true")"));
}

TEST_F(ScaleCommand, LightErrorsOfShadowedLightsAreHeldAgainstRaysWithTheirConfidence) {
  writeText(folder / "scene.json", matteScene());
  size = "120x68";
  succeed(
      "--lights 100,10000 --vary light-error=0,1/16,confidence=0.6,0.99 --shadows exact --repeat 1 -o run "
      "--plot plot.svg");
  const std::vector<Row> rows = readCsv(folder / "run/results.csv");
  ASSERT_EQ(rows.size(), 2u * 3) << "lights one by one have no confidence";
  for (const Row& row : rows) {
    EXPECT_EQ(row.at("reach"), "inf");
    EXPECT_EQ(row.at("truth"), "");
    // Few lights are summed one by one.
    const bool is_sampled = row.at("light-error") == "1/16" && row.at("lights") == "10000";
    EXPECT_EQ(row.at("max_bound").empty(), !is_sampled);
    if (!is_sampled) {
      EXPECT_LT(std::stod(row.at("max_abs")), 1e-3) << "shadows are those of rays";
      continue;
    }
    EXPECT_EQ(row.at("stated"), row.at("confidence"));
    EXPECT_GT(std::stod(row.at("held")), row.at("confidence") == "0.99" ? 0.9 : 0.5);
    EXPECT_GT(std::stod(row.at("mean_bound")), 0);
    EXPECT_LE(std::stod(row.at("mean_error")), 1.0 / 16);
    EXPECT_FALSE(row.at("bound_map").empty());
    EXPECT_GT(std::stod(row.at("sampled_light_ms")), 0);
    EXPECT_GT(std::stod(row.at("pairs_evaluated")), std::stod(row.at("pixels_lit")));
    EXPECT_EQ(std::stod(row.at("pairs_in_range")), 10000 * std::stod(row.at("pixels_lit")));
  }
  EXPECT_THAT(readText(folder / "plot.svg"), HasSubstr(">confidence 0.99, true error<"));
  EXPECT_THAT(refuse("--lights 10 --vary confidence --repeat 1 -o other"), HasSubstr("--shadows exact"));
}

TEST_F(ScaleCommand, BrokenBoundsAreToldAndEndWithOne) {
  writeText(folder / "scene.json", matteScene());
  size = "240x135";
  succeed("--lights 3000 --vary light-error=1/16,1/64 --repeat 1 -o run");
  std::string log = readText(folder / "run/results.jsonl");
  const std::string kept = "\"violations\":0";
  log.replace(log.find(kept), kept.size(), "\"violations\":5");
  writeText(folder / "run/results.jsonl", log);
  const Outcome outcome = runLine(folder, "luciole scale merge run -o merged");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.err, HasSubstr("lights=3000 light-error=1/16: 5 of "));
  EXPECT_TRUE(isOneLine(outcome.err)) << outcome.err;
  EXPECT_THAT(readText(folder / "merged/report.html"), HasSubstr("5 of "));
}

TEST_F(ScaleCommand, WithoutRangeIsAWayToReachThatTakesItsTurn) {
  writeText(folder / "scene.json", matteScene());
  succeed("--lights 50 --vary no-range,density=2,cutoff=0.1 --repeat 1 -o run");
  const std::vector<Row> rows = readCsv(folder / "run/results.csv");
  ASSERT_EQ(rows.size(), 3u);
  std::set<std::string> reaches;
  for (const Row& row : rows) {
    EXPECT_EQ(row.at("reach") == "inf", row.at("no-range") == "true");
    reaches.insert(row.at("reach"));
  }
  EXPECT_EQ(reaches.size(), 3u);
  // With a range that is asked for, no light is stood for.
  succeed("--lights 2000 --vary light-error=1/16 --density 8 --repeat 1 -o ranged");
  const std::vector<Row> ranged = readCsv(folder / "ranged/results.csv");
  EXPECT_NE(ranged[0].at("reach"), "inf");
  EXPECT_EQ(ranged[0].at("max_bound"), "");
}

TEST_F(ScaleCommand, LightsOneByOneThatWouldTakeLongAreLeftOutBesideLightErrors) {
  writeText(folder / "scene.json", matteScene());
  // 48 x 27 pixels: 1.3e10 pairs with the most.
  const Outcome outcome =
      scale("--lights 1000,10000000 --vary light-error=0,1 --repeat 1 --shard 1/4 -o run");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("so many lights one by one take long: 1"));
  EXPECT_THAT(outcome.err, HasSubstr("1 of 3 points are done"));
}

TEST_F(ScaleCommand, MoreSamplesComeNearerToATruthOfMore) {
  succeed("--lights 100 --vary samples=1,16 --repeat 1 -o run");
  const std::vector<Row> rows = readCsv(folder / "run/results.csv");
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_LT(std::stod(rows[1].at("mean_abs")), std::stod(rows[0].at("mean_abs")) / 2);
}

TEST_F(ScaleCommand, ShadowsAreCastWhereTheyAreAskedForAndJudgedByRays) {
  succeed("--lights 20 --vary shadows=off,exact --density 10 --repeat 1 -o run");
  const std::vector<Row> rows = readCsv(folder / "run/results.csv");
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_NE(readText(folder / ("run/" + rows[0].at("picture"))),
            readText(folder / ("run/" + rows[1].at("picture"))));
  EXPECT_EQ(rows[0].at("beam_shadows_ms"), "");
  EXPECT_GT(std::stod(rows[1].at("beam_shadows_ms")), 0);
  for (const Row& row : rows) EXPECT_LT(std::stod(row.at("mean_abs")), 0.25 / 255);
}

TEST_F(ScaleCommand, PicturesWithoutShadowsBeatNoneThatHaveThem) {
  succeed("--lights 20 --vary shadows=off,hard,pcf,exact --density 10 --repeat 2 -o run");
  std::map<std::string, int> on_front;
  for (const Row& row : readCsv(folder / "run/results.csv")) {
    EXPECT_EQ(row.at("truth"), row.at("shadows") == "off" ? "no shadows" : "shadows by rays");
    on_front[row.at("truth")] += row.at("front") == "1";
  }
  EXPECT_EQ(on_front["no shadows"], 1);
  EXPECT_GE(on_front["shadows by rays"], 1);
}

TEST_F(ScaleCommand, LargerShadowMapsAreNearerToTheirTruthAndNeedNoneWithoutShadows) {
  succeed("--lights 5 --vary shadows=off,hard,shadow-size=16,1024 --range 6 --repeat 1 -o run");
  const std::vector<Row> rows = readCsv(folder / "run/results.csv");
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[1].at("shadow-size"), "16");
  EXPECT_LT(std::stod(rows[2].at("mean_abs")), std::stod(rows[1].at("mean_abs")));
  EXPECT_EQ(rows[1].at("truth"), rows[2].at("truth"));
}

TEST_F(ScaleCommand, LightsOfAFileMakeThePictureThatRenderMakesOfThem) {
  writeText(folder / "lights.csv", "x,y,z,r,g,b,range\n0,2,0,1,1,1,3\n1,1,2,1,0.5,0,2\n-1,1,2,0,1,0,2\n");
  succeed("--lights 1,2 --field lights.csv --repeat 1 -o run");
  std::string lit = kSmallScene;
  const std::size_t lights = lit.find("\"lights\"");
  lit = lit.substr(0, lights) + R"("lights": [
    {"type": "point", "position": [0, 2, 0], "color": [1, 1, 1], "range": 3},
    {"type": "point", "position": [1, 1, 2], "color": [1, 0.5, 0], "range": 2}]})";
  writeText(folder / "lit.json", lit);
  ASSERT_EQ(runLine(folder, "luciole render lit.json --size 48x27 -o lit.png --quiet").status, 0);
  const std::vector<Row> rows = readCsv(folder / "run/results.csv");
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[1].at("reach"), "3");
  EXPECT_EQ(readImage(folder / ("run/" + rows[1].at("picture"))).pixels,
            readImage(folder / "lit.png").pixels);
  EXPECT_NE(readImage(folder / ("run/" + rows[0].at("picture"))).pixels,
            readImage(folder / "lit.png").pixels);
  EXPECT_THAT(refuse("--lights 1,4 --field lights.csv --repeat 1 -o more"), HasSubstr("lights.csv"));
}

TEST_F(ScaleCommand, TheVariantOfAGltfFileIsAskedFor) {
  writeText(folder / "wall.gltf", R"({"asset": {"version": "2.0"}, "scenes": [{}]})");
  const Outcome outcome =
      runLine(folder, "luciole scale wall.gltf --variant worn --lights 1 --repeat 1 -o run");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, HasSubstr("has no variant 'worn'"));
}

TEST_F(ScaleCommand, PointThatTheMachineCannotDoIsToldAndTheOthersAreMade) {
  // 10⁸ lights take more than 10 GB, which are refused when they are asked for.
  const Outcome outcome =
      runLine(folder,
              "ulimit -v 10000000; luciole scale scene.json --size 48x27 --check-pixels 40 "
              "--lights 1,100000000 --repeat 2 -o run");
  EXPECT_EQ(outcome.status, 3);
  EXPECT_THAT(outcome.err, HasSubstr("lights=100000000: "));
  EXPECT_THAT(outcome.err, HasSubstr("1 of 2 points"));
  const std::vector<Row> rows = readCsv(folder / "run/results.csv");
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0].at("runs"), "2");
  EXPECT_THAT(readText(folder / "run/report.html"), HasSubstr("</html>"));
}

TEST_F(ScaleCommand, RefusesAFolderOfAnotherExperiment) {
  succeed("--lights 1 --repeat 1 -o run");
  const std::string log = readText(folder / "run/results.jsonl");
  EXPECT_THAT(refuse("--lights 1,2 --repeat 1 -o run"), HasSubstr("numbers of lights"));
  EXPECT_THAT(refuse("--lights 1 --repeat 1 --seed 3 -o run"), HasSubstr("seed"));
  std::string moved = kSmallScene;
  moved.replace(moved.find("[3, 2, 5]"), 9, "[3, 2, 6]");
  writeText(folder / "scene.json", moved);
  EXPECT_THAT(refuse("--lights 1 --repeat 1 -o run"), HasSubstr("state of the scene"));
  EXPECT_EQ(readText(folder / "run/results.jsonl"), log);
}

TEST_F(ScaleCommand, WrongArgumentsAreRefusedBeforeAnythingIsWritten) {
  for (const auto& [arguments, said] : std::initializer_list<std::pair<const char*, const char*>>{
           {"-o run", "--lights"},
           {"--lights 1", "--output"},
           {"--lights 0 -o run", "'0'"},
           {"--lights 10,1 -o run", "above"},
           {"--lights 1,x -o run", "'x'"},
           {"--lights 1,-1 -o run", "'-1'"},
           {"--lights 1,...,10 -o run", "two numbers"},
           {"--lights 1,10,... -o run", "after the dots"},
           {"--lights 1,10,...,500 -o run", "lead"},
           {"--lights 1,200000000 -o run", "200000000"},
           {"--lights 1 --vary colour -o run", "culling"},
           {"--lights 1 --vary culling=some -o run", "culling=some"},
           {"--lights 1 --vary tile=4,4 -o run", "there twice"},
           {"--lights 1 --vary tile,tile -o run", "there twice"},
           {"--lights 1 --vary tile= -o run", "none"},
           {"--lights 1 --vary tile=4,- -o run", "none"},
           {"--lights 1 --vary range --density 3 -o run", "expected one"},
           {"--lights 1 --vary range --cutoff 1 -o run", "expected one"},
           {"--lights 1 --vary cutoff --no-range -o run", "expected one"},
           {"--lights 1 --no-range --density 2 -o run", "--density"},
           {"--lights 1 --vary light-error=2 -o run", "light-error=2"},
           {"--lights 1 --tile 8 --vary tile -o run", "--tile"},
           {"--lights 1 --range 1 --density 2 -o run", "--density"},
           {"--lights 1 --range 0 -o run", "--range"},
           {"--lights 1 --vary shadow-size=8 -o run", "shadow-size=8"},
           {"--lights 1 --shadow-size 32768 -o run", "--shadow-size"},
           {"--lights 1 --field ring -o run", "ring"},
           {"--lights 1 --field none.csv -o run", "none.csv"},
           {"--lights 1 --shard 3/2 -o run", "3/2"},
           {"--lights 1 --repeat 0 -o run", "--repeat"},
           {"--lights 1 --check-pixels 0 -o run", "--check-pixels"},
           {"--lights 1 --plot plot.png -o run", "plot.png"},
           {"--lights 1 --plot no/plot.svg -o run", "no"},
           {"--lights 1 -o scene.json/run", "scene.json/run"}}) {
    EXPECT_THAT(refuse(arguments), HasSubstr(said)) << arguments;
    EXPECT_FALSE(std::filesystem::exists(folder / "run")) << arguments;
  }
  EXPECT_EQ(runLine(folder, "luciole scale missing.json --lights 1 -o run").status, 2);
  EXPECT_EQ(runLine(folder, "luciole scale merge -o run").status, 2);
  EXPECT_EQ(runLine(folder, "luciole scale merge nothing -o run").status, 2);
  EXPECT_FALSE(std::filesystem::exists(folder / "run"));
}

TEST_F(ScaleCommand, OwnLightsStayAsTheyAre) {
  writeText(folder / "own.csv",
            "x,y,z,r,g,b,range,quadratic,dx,dy,dz,cutoff,exponent\n"
            "0,2,1,3,2,1,,1,,,,,\n"
            "1,2,1,0,2,1,4,,,,,,\n"
            "0,3,1,5,5,5,,1,0,-1,0,40,2\n"
            ",,,0.1,0.2,0.3,,,0,-1,-1,,\n");
  const std::string box_scene = readText(folder / "scene.json");
  succeed("--field own.csv --own-lights --lights 1,2,4 --exposure -2 --repeat 1 -o run");
  const std::vector<Row> rows = readCsv(folder / "run/results.csv");
  ASSERT_EQ(rows.size(), 3u);
  // The first of the file, by a scene that has them as its only lights.
  for (const Row& row : rows) {
    auto scene = nlohmann::json::parse(box_scene, nullptr, true, true);
    scene.erase("lights");
    scene["light_fields"] =
        nlohmann::json::array({nlohmann::json{{"csv", "own.csv"}, {"count", std::stoi(row.at("lights"))}}});
    writeText(folder / "lit.json", scene.dump());
    ASSERT_EQ(runLine(folder, "luciole render lit.json --size " + size +
                                  " --shadows off --exposure -2 --quiet -o lit.png")
                  .status,
              0);
    EXPECT_EQ(readImage(folder / "lit.png").pixels, readImage(folder / ("run/" + row.at("picture"))).pixels)
        << row.at("lights") << " lights";
    EXPECT_LT(std::stod(row.at("max_abs")), 1e-5);
  }
  EXPECT_THAT(refuse("--field own.csv --density 3 --lights 4 -o x"), HasSubstr("--own-lights in place of"));
  EXPECT_THAT(refuse("--field own.csv --own-lights --lights 5 -o x"), HasSubstr("4 lights, expected 5"));
  EXPECT_THAT(refuse("--field own.csv --own-lights --no-range --lights 4 -o x"), HasSubstr("--no-range"));
  EXPECT_THAT(refuse("--own-lights --vary density --lights 1 -o x"), HasSubstr("leaves lights as they are"));
  EXPECT_THAT(refuse("--own-lights --field ball --lights 1 -o x"), HasSubstr("expected a .csv file"));
  // Another list under the name of the first is another experiment.
  writeText(folder / "own.csv", "0,2,1,3,2,1\n0,2,1,3,2,1\n0,2,1,3,2,1\n0,2,1,3,2,1\n");
  EXPECT_THAT(refuse("--field own.csv --own-lights --lights 1,2,4 --exposure -2 --repeat 1 -o run"),
              HasSubstr("own.csv's SHA-256"));
}

TEST_F(ScaleCommand, TheScenesOwnLightsAreTakenInItsOrder) {
  succeed("--own-lights --lights 1 --shadows exact --repeat 1 -o run");
  auto scene = nlohmann::json::parse(readText(folder / "scene.json"), nullptr, true, true);
  scene["lights"] = nlohmann::json::array({scene["lights"][0]});
  scene.erase("light_fields");
  writeText(folder / "one.json", scene.dump());
  ASSERT_EQ(runLine(folder, "luciole render one.json --size " + size + " --shadows exact --quiet -o one.png")
                .status,
            0);
  const std::vector<Row> rows = readCsv(folder / "run/results.csv");
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(readImage(folder / "one.png").pixels,
            readImage(folder / ("run/" + rows[0].at("picture"))).pixels);
  EXPECT_THAT(refuse("--own-lights --lights 1000 -o x"), HasSubstr("lights of its own, expected 1000"));
}

TEST_F(ScaleCommand, AGBufferIsLitLikeItsScene) {
  ASSERT_EQ(runLine(folder, "luciole gbuffer scene.json --size " + size + " --quiet -o g.exr").status, 0);
  const std::string of_both = "--lights 10,1000 --vary culling --check-pixels 40 --repeat 1 --seed 3 ";
  ASSERT_EQ(runLine(folder, "luciole scale scene.json --size " + size + " " + of_both + "-o drawn").status,
            0);
  const Outcome outcome = runLine(folder, "luciole scale scene.json --gbuffer g.exr " + of_both + "-o read");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const std::vector<Row> drawn = readCsv(folder / "drawn/results.csv"),
                         read = readCsv(folder / "read/results.csv");
  ASSERT_EQ(drawn.size(), read.size());
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    EXPECT_EQ(readImage(folder / ("read/" + read[i].at("picture"))).pixels,
              readImage(folder / ("drawn/" + drawn[i].at("picture"))).pixels);
    EXPECT_EQ(read[i].at("mean_abs"), drawn[i].at("mean_abs"));
    EXPECT_FALSE(read[i].contains("rasterize_ms"));
  }
  EXPECT_THAT(readText(folder / "read/results.jsonl"), HasSubstr("G-buffer's SHA-256"));
  // Without a scene its surfaces are lit in the dark.
  EXPECT_EQ(runLine(folder, "luciole scale --gbuffer g.exr --lights 5 --repeat 1 -o alone").status, 0);
  for (const char* of_view : {"--size 4x4", "--samples 4", "--vary samples", "--shading flat"}) {
    const Outcome refused =
        runLine(folder, std::string("luciole scale --gbuffer g.exr --lights 5 -o x ") + of_view);
    EXPECT_EQ(refused.status, 2) << of_view;
    EXPECT_THAT(refused.err, HasSubstr("a G-buffer has its size, camera, shading and samples already"));
  }
}

TEST_F(ScaleCommand, AFrameOfASceneThatMovesIsLit) {
  auto scene = nlohmann::json::parse(readText(folder / "scene.json"), nullptr, true, true);
  scene["objects"][1]["keys"] = nlohmann::json::parse(
      R"([{"frame": 1, "translate": [0, 1, 0]}, {"frame": 9, "translate": [2, 1, 0]}])");
  writeText(folder / "scene.json", scene.dump());
  const std::string arguments = "--own-lights --lights 1 --repeat 1 ";
  succeed(arguments + "-o first");
  succeed(arguments + "--frames 9 -o ninth");
  const std::string first = readCsv(folder / "first/results.csv")[0].at("picture");
  const std::string ninth = readCsv(folder / "ninth/results.csv")[0].at("picture");
  EXPECT_NE(readImage(folder / ("first/" + first)).pixels, readImage(folder / ("ninth/" + ninth)).pixels);
  EXPECT_THAT(refuse(arguments + "--frames 1-3 -o x"), HasSubstr("expected one frame"));
  EXPECT_THAT(refuse(arguments + "--frames 3 -o ninth"), HasSubstr("ninth"));
}

}  // namespace
}  // namespace luciole::test
