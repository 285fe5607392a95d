#include "tools/scale/scale_table.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <sstream>
#include <string>
#include <vector>

#include "tools/scale/made_up_experiment.hpp"

namespace luciole::test {
namespace {

using testing::HasSubstr;
using testing::Not;

/// Of 4 + 36 stages; 10 ms whatever the lights, `each` ms a light for the first variant and a tenth for the
/// others, and no time to speak of for the rest.
ScaleSummary summaryOf(const std::vector<std::uint64_t>& counts, std::size_t variants, double each) {
  ScaleResults results{madeUpExperiment(), {}, {}};
  ScaleDescription& description = results.description;
  description.lights = counts;
  description.repeats = 1;
  description.axes = {{"culling", {}}};
  description.points.clear();
  for (std::size_t v = 0; v < variants; ++v) description.axes[0].values.push_back("way " + std::to_string(v));
  for (const std::uint64_t lights : counts)
    for (std::size_t v = 0; v < variants; ++v) {
      description.points.push_back({lights, {description.axes[0].values[v]}});
      PointRecord& record = results.records[pointName(description, description.points.back())];
      record.check = madeUpCheck("a", 0.25);
      record.runs[0] = madeUpRun(10, (v == 0 ? each : each / 10) * double(lights));
      for (int i = 0; i < 36; ++i) record.runs[0].stages.emplace_back("idle " + std::to_string(i), 1e-6);
    }
  return summarizeScale(results);
}

std::vector<std::string> linesOf(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

TEST(ScaleTable, LeadsWithTimeErrorAndMemoryOfEachVariantAgainstLights) {
  const std::vector<std::string> lines = linesOf(scaleTable(summaryOf({1, 10, 100, 1000, 10000}, 2, 0.5)));
  ASSERT_GE(lines.size(), 12u);
  EXPECT_EQ(lines[0],
            "| lights | culling |     ms | spread | mean error | largest |  relMSE |   SMAPE | memory, MiB | "
            "front |");
  EXPECT_EQ(lines[2],
            "| 1      |   way 0 |   10.5 |  ± 0 % |    2.5e-01 | 5.0e-01 | 7.5e-01 | 1.0e+00 |           0 | "
            "      |");
  EXPECT_EQ(lines[11],
            "| 10000  |   way 1 |  510.0 |  ± 0 % |    2.5e-01 | 5.0e-01 | 7.5e-01 | 1.0e+00 |           0 | "
            "    * |");
}

TEST(ScaleTable, NamesTheTruthWhereErrorsAreOfDifferentOnes) {
  ScaleSummary summary = summaryOf({1, 10}, 2, 0.5);
  summary.points[0].truth = summary.points[2].truth = "no shadows";
  summary.points[1].truth = summary.points[3].truth = "shadows by rays";
  const std::vector<std::string> lines = linesOf(scaleTable(summary));
  EXPECT_THAT(lines[0], HasSubstr("| front |           truth |"));
  EXPECT_THAT(lines[2], HasSubstr("|      no shadows |"));
  EXPECT_THAT(lines[3], HasSubstr("| shadows by rays |"));
}

TEST(ScaleTable, TellsTheGrowthOfTheWholeAndOfStagesThatMatterAlone) {
  const std::string text = scaleTable(summaryOf({1, 10, 100, 1000, 10000}, 2, 0.5));
  EXPECT_THAT(text, HasSubstr("| way 0   |   1.00 (1.00 to 1.00) | shade 1.00 (1.00 to 1.00) |"));
  EXPECT_THAT(text, Not(HasSubstr("idle")));
  EXPECT_LE(linesOf(text).size(), 2 + 10 + 3 + 2 + 2u);
}

TEST(ScaleTable, SaysWhyThereIsNoGrowth) {
  const std::string few = scaleTable(summaryOf({1, 10, 100}, 1, 0.5));
  EXPECT_THAT(few, HasSubstr("too few numbers of lights: 3 of 5"));
  EXPECT_THAT(few, Not(HasSubstr("shade")));
  EXPECT_THAT(scaleTable(summaryOf({1, 10, 100, 1000, 10000}, 1, 0)), HasSubstr("no growth beyond noise"));
}

TEST(ScaleTable, ManyPointsShowThoseOfTheMostLightsAndSayWhereTheOthersAre) {
  const std::string text = scaleTable(summaryOf({1, 10, 100, 1000, 10000}, 12, 0.5));
  EXPECT_THAT(text, HasSubstr("The 48 points of fewer lights are in results.csv."));
  EXPECT_LE(linesOf(text).size(), 2 + 12 + 1 + 3 + 2 + 12u);
}

TEST(ScaleTable, BoundsStandBesideErrorsWhereThereAreAny) {
  const std::string text = scaleTable(summarizeScale(madeUpLightErrors()));
  const std::vector<std::string> lines = linesOf(text);
  EXPECT_THAT(lines[0], HasSubstr("| front | largest bound |    mean | error / bound, largest | mean |"));
  EXPECT_THAT(lines[2], HasSubstr("|             – |       – |                      – |    – |"));
  EXPECT_THAT(lines[6], HasSubstr("|       2.5e-01 | 1.2e-01 |                   0.50 | 0.12 |"));
  EXPECT_THAT(text, HasSubstr("Bounds are shares of the larger of 1 and the colour"));
  EXPECT_THAT(text, Not(HasSubstr("pixels within")));
}

TEST(ScaleTable, WhereBoundsHoldWithAConfidenceItSaysHowOftenTheyDid) {
  ScaleResults results = madeUpLightErrors();
  KeptBounds& bounds = *results.records.at("lights=100 field=box light-error=1/4").check->bounds;
  bounds.confidence = 0.9;
  bounds.held = 0.875;
  const std::string text = scaleTable(summarizeScale(results));
  const std::vector<std::string> lines = linesOf(text);
  EXPECT_THAT(lines[0], HasSubstr("| pixels within, % |"));
  EXPECT_THAT(lines[2], HasSubstr("|                – |"));
  EXPECT_THAT(lines[6], HasSubstr("|            87.50 |"));
  EXPECT_THAT(text, HasSubstr("with the stated confidence"));
}

TEST(ScaleTable, OneWayOfManyHasNoColumnForIt) {
  ScaleSummary summary = summaryOf({1, 10}, 1, 0.5);
  summary.description.axes.clear();
  for (PointSummary& point : summary.points) point.point.values.clear();
  for (StageGrowth& row : summary.growth) row.values.clear();
  EXPECT_EQ(linesOf(scaleTable(summary))[0],
            "| lights |   ms | spread | mean error | largest |  relMSE |   SMAPE | memory, MiB | front |");
}

TEST(ScaleTable, NothingMeasuredIsNoTable) { EXPECT_EQ(scaleTable(ScaleSummary{}), ""); }

}  // namespace
}  // namespace luciole::test
