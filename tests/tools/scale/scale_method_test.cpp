#include "tools/scale/scale_method.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "luciole/error.hpp"
#include "shared_files.hpp"
#include "tools/scale/made_up_experiment.hpp"
#include "tools/scale/scale_files.hpp"
#include "tools/scale/scale_plot.hpp"
#include "tools/scale/scale_summary.hpp"
#include "tools/scale/scale_table.hpp"
#include "tools/scale/scale_truth.hpp"

namespace luciole::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// Two ways by 1 and 100 lights, and "theirs" by 100 alone, and "asked" by both.
ScaleExperiment withMethods() {
  ScaleExperiment experiment;
  experiment.description = madeUpExperiment();
  experiment.description.repeats = 4;
  experiment.tasks.resize(4);
  addMethods(experiment, {{"theirs", 1}, {"asked", 4}},
             {{std::nullopt, OtherPicture{"theirs.exr", 7}}, {OtherPicture{}, OtherPicture{}}});
  return experiment;
}

TEST(ScaleMethods, JoinEachNumberOfLightsAfterItsOwnVariants) {
  const ScaleExperiment experiment = withMethods();
  const ScaleDescription& description = experiment.description;
  std::vector<std::string> names;
  for (const ScalePoint& point : description.points) names.push_back(pointName(description, point));
  EXPECT_THAT(names,
              ElementsAre("lights=1 culling=none method=luciole", "lights=1 culling=tiles method=luciole",
                          "lights=1 culling=- method=asked", "lights=100 culling=none method=luciole",
                          "lights=100 culling=tiles method=luciole", "lights=100 culling=- method=theirs",
                          "lights=100 culling=- method=asked"));
  ASSERT_EQ(experiment.tasks.size(), 7u);
  EXPECT_FALSE(experiment.tasks[1].other);
  EXPECT_EQ(experiment.tasks[2].other->file, "");
  EXPECT_EQ(experiment.tasks[5].other->file, "theirs.exr");
  EXPECT_EQ(methodOf(description, description.points[0]), nullptr);
  EXPECT_EQ(methodOf(description, description.points[5])->name, "theirs");
  EXPECT_EQ(runsOf(description, description.points[0]), 4);
  EXPECT_EQ(runsOf(description, description.points[5]), 1);
  EXPECT_THAT(description.axes[0].values, ElementsAre("none", "tiles", "-"));
  EXPECT_THAT(description.axes[1].values, ElementsAre("luciole", "theirs", "asked"));
}

TEST(ScaleMethods, HaveTheTruthOfAllOthersAndJoinNoneOfSeveral) {
  ScaleExperiment experiment;
  ScaleDescription& description = experiment.description = madeUpExperiment();
  description.axes = {{"shadows", {"hard", "exact"}}};
  for (std::size_t i = 0; i < 4; ++i) description.points[i].values = {i % 2 ? "exact" : "hard"};
  experiment.tasks.resize(4);
  addMethods(experiment, {{"theirs", 0}}, {{OtherPicture{"a", {}}, OtherPicture{"b", {}}}});
  for (const ScalePoint& point : description.points)
    EXPECT_EQ(truthName(description, point), "shadows by rays");

  ScaleExperiment other;
  other.description = madeUpExperiment();
  other.description.axes = {{"shadows", {"off", "exact"}}};
  for (std::size_t i = 0; i < 4; ++i) other.description.points[i].values = {i % 2 ? "exact" : "off"};
  other.tasks.resize(4);
  try {
    addMethods(other, {{"theirs", 0}}, {{OtherPicture{"a", {}}, OtherPicture{"b", {}}}});
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(),
                HasSubstr("against theirs: the variants are meant to make different pictures, 'no "
                          "shadows' and 'shadows by rays'"));
  }
}

/// Luciole takes 10, 20, 30, 40 ms in four rounds without culling, and half of that with it; "theirs" 50 ms
/// once, "asked" a tenth.
ScaleResults resultsWithMethods() {
  ScaleResults results{withMethods().description, {madeUpMachine("one")}, {}};
  const ScaleDescription& description = results.description;
  for (std::size_t i = 0; i < description.points.size(); ++i) {
    const ScalePoint& point = description.points[i];
    const ScaleMethod* method = methodOf(description, point);
    PointRecord& record = results.records[pointName(description, point)];
    record.check = madeUpCheck(std::to_string(i), method ? 1e-3 : 1e-6);
    if (method) record.check->list_map.clear();
    for (int round = 0; round < runsOf(description, point); ++round) {
      const double own = 10 * (round + 1) * (point.values[0] == "tiles" ? 0.5 : 1);
      record.runs[round] = !method                    ? madeUpRun(0.25 * own, 0.75 * own)
                           : method->name == "theirs" ? PointRun{.stages = {{kOtherStage, 50}}}
                                                      : PointRun{.stages = {{kOtherStage, own / 10}}};
    }
  }
  return results;
}

TEST(ScaleMethods, TimesAreToldAsMultiplesOfTheFirstVariantRoundByRound) {
  const ScaleSummary summary = summarizeScale(resultsWithMethods());
  ASSERT_EQ(summary.points.size(), 7u);
  EXPECT_TRUE(summary.incomplete.empty());
  EXPECT_FALSE(summary.points[3].times_first) << "the first itself";
  // Half, whatever else the machine did in a round.
  for (const double figure : {summary.points[4].times_first->median, summary.points[4].times_first->low,
                              summary.points[4].times_first->high})
    EXPECT_EQ(figure, 0.5);
  EXPECT_NEAR(summary.points[6].times_first->median, 0.1, 1e-15);
  // One time against four: 5, 2.5, 5/3 and 5/4.
  EXPECT_NEAR(summary.points[5].times_first->median, (2.5 + 5.0 / 3) / 2, 1e-15);
  EXPECT_GE(summary.points[5].times_first->low, 1.25);
  EXPECT_LE(summary.points[5].times_first->high, 5);
  EXPECT_LT(summary.points[5].times_first->low, summary.points[5].times_first->high);
}

TEST(ScaleMethods, ShareTheFrontAndHaveNoStagesOrCounts) {
  const ScaleSummary summary = summarizeScale(resultsWithMethods());
  EXPECT_TRUE(summary.points[4].front) << "right";
  EXPECT_TRUE(summary.points[6].front) << "fast";
  EXPECT_FALSE(summary.points[5].front) << "neither";
  EXPECT_TRUE(summary.points[5].stages.empty());
  EXPECT_EQ(summary.points[5].milliseconds.median, 50);
  const auto page = nlohmann::json::parse(pageData(summary, "", ""));
  EXPECT_EQ(page["first"], (nlohmann::json{{"culling", "none"}, {"method", "luciole"}}));
  EXPECT_TRUE(page["points"][5]["pairs_evaluated"].is_null());
  EXPECT_TRUE(page["points"][5]["peak_bytes"].is_null());
  EXPECT_TRUE(page["points"][5]["tile_map"].is_null());
  EXPECT_EQ(page["points"][4]["times_first"]["median"], 0.5);
  EXPECT_TRUE(page["points"][3]["times_first"].is_null());
  std::istringstream lines(scaleCsv(summary));
  std::string head, line;
  std::getline(lines, head);
  EXPECT_THAT(head, HasSubstr(",p999_abs,times_first,times_first_low,times_first_high,front,"));
  for (int i = 0; i < 6; ++i) std::getline(lines, line);
  EXPECT_THAT(line, testing::StartsWith("100,-,theirs,1,50,50,50,,,,,,,1.5,,,,,,,16,"));
  EXPECT_THAT(scaleTable(summary), HasSubstr("| times the first (95 %) |\n"));
  EXPECT_THAT(scaleTable(summary), HasSubstr("|       0.5 (0.5 to 0.5) |\n"));
  EXPECT_THAT(scalePlot(summary), HasSubstr(">theirs<"));
}

TEST(ScaleMethods, WithoutTimesHaveAnErrorAlone) {
  ScaleResults results = resultsWithMethods();
  results.description.methods[0].runs = 0;
  results.records.at("lights=100 culling=- method=theirs").runs.clear();
  const ScaleSummary summary = summarizeScale(results);
  ASSERT_EQ(summary.points.size(), 7u);
  EXPECT_TRUE(summary.incomplete.empty());
  EXPECT_TRUE(std::isnan(summary.points[5].milliseconds.median));
  EXPECT_FALSE(summary.points[5].front);
  EXPECT_FALSE(summary.points[5].times_first);
  const std::string page = pageData(summary, "", "");
  EXPECT_EQ(page.find("nan"), std::string::npos);
  EXPECT_TRUE(nlohmann::json::parse(page)["points"][5]["milliseconds"]["median"].is_null());
  EXPECT_THAT(scaleCsv(summary), HasSubstr("\n100,-,theirs,0,,,,"));
  EXPECT_THAT(scaleTable(summary), HasSubstr("|  theirs |    – |"));
  EXPECT_EQ(scalePlot(summary).find("theirs"), std::string::npos);
}

TEST(ScaleMethods, ALogKeepsThem) {
  const TemporaryFolder folder;
  const ScaleResults made = resultsWithMethods();
  {
    ScaleLog log(folder.path().string(), made.description);
    for (const auto& [name, record] : made.records) {
      log.append(name, *record.check);
      for (const auto& [round, run] : record.runs) log.append(name, round, run);
    }
  }
  const ScaleResults read = readScaleLog(folder.path().string());
  EXPECT_EQ(read.description, made.description);
  const PointRecord& record = read.records.at("lights=100 culling=- method=theirs");
  EXPECT_EQ(record.check->list_map, "");
  EXPECT_EQ(record.check->error.mean_abs, 1e-3);
  EXPECT_EQ(record.runs.at(0).stages[0].second, 50);
}

TEST(ScaleMethods, PicturesOfAnotherSizeOrWithWrongValuesAreRefused) {
  const TemporaryFolder folder;
  const auto refusal = [&](const Image& image, const std::string& name) -> std::string {
    writeImage(image, folder / name, {});
    try {
      readMethodPicture(folder / name, {2, 1});
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  };
  const std::vector<float> six(6, 0.5f);
  EXPECT_EQ(refusal({2, 1, {"R", "G", "B"}, six}, "a.npy"), "accepted");
  EXPECT_THAT(refusal({1, 2, {"R", "G", "B"}, six}, "b.npy"),
              HasSubstr("b.npy: 1 x 2 pixels, expected 2 x 1"));
  EXPECT_THAT(refusal({2, 1, {"R", "G", "B"}, {0, NAN, 0, INFINITY, 0, 0}}, "c.npy"),
              HasSubstr("c.npy: 2 values are not finite"));
  EXPECT_THAT(refusal({2, 1, {"Y"}, {1, 1}}, "d.exr"), HasSubstr("d.exr: channels 'Y', expected R G B"));
  // Other layers don't matter, nor the order of colours.
  const Image layers{2, 1, {"Z", "B", "G", "R"}, {INFINITY, 3, 2, 1, 0, 6, 5, 4}};
  EXPECT_EQ(refusal(layers, "e.exr"), "accepted");
  EXPECT_EQ(readMethodPicture(folder / "e.exr", {2, 1}).pixels, (std::vector<float>{1, 2, 3, 4, 5, 6}));
  EXPECT_THROW(readMethodPicture(folder / "none.exr", {2, 1}), InputError);
}

}  // namespace
}  // namespace luciole::test
