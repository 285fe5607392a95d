#include "tools/scale/scale_summary.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "luciole/error.hpp"
#include "shared_files.hpp"
#include "tools/scale/made_up_experiment.hpp"
#include "tools/scale/scale_files.hpp"

namespace luciole::test {
namespace {

/// Without culling 10 ms a light, with it 1 ms; the last point lacks a run.
ScaleResults madeUpResults() {
  ScaleResults results{madeUpExperiment(), {madeUpMachine("one")}, {}};
  const ScaleDescription& description = results.description;
  for (std::size_t i = 0; i < 4; ++i) {
    const double lights = double(description.points[i].lights), each = i % 2 == 0 ? 10 : 1;
    PointRecord& record = results.records[pointName(description, description.points[i])];
    record.check = madeUpCheck(std::to_string(i), 0.25);
    record.runs[0] = madeUpRun(1, each * lights);
    if (i < 3) record.runs[1] = madeUpRun(3, each * lights);
  }
  return results;
}

TEST(ScaleSummary, TotalsStagesAndQuartilesAreThoseOfTheRuns) {
  const ScaleSummary summary = summarizeScale(madeUpResults());
  ASSERT_EQ(summary.points.size(), 4u);
  const PointSummary& point = summary.points[0];
  EXPECT_EQ(point.runs, 2);
  EXPECT_EQ(point.milliseconds.median, 12);  // of 11 and 13
  EXPECT_EQ(point.milliseconds.low, 11.5);
  EXPECT_EQ(point.milliseconds.high, 12.5);
  ASSERT_EQ(point.stages.size(), 2u);
  EXPECT_EQ(point.stages[0].name, "cull");
  EXPECT_EQ(point.stages[0].milliseconds.median, 2);
  EXPECT_EQ(point.stages[1].milliseconds.high, 10);
  EXPECT_EQ(point.peak_bytes, 2000u);
  EXPECT_EQ(summary.incomplete.size(), 1u);
}

TEST(ScaleSummary, FrontComparesPicturesByAsManyLights) {
  const ScaleSummary summary = summarizeScale(madeUpResults());
  EXPECT_FALSE(summary.points[0].front);
  EXPECT_TRUE(summary.points[1].front);
  EXPECT_FALSE(summary.points[2].front);
  EXPECT_TRUE(summary.points[3].front);  // beaten by those of fewer lights only
}

TEST(ScaleSummary, EachErrorHasItsFront) {
  ScaleResults results = madeUpResults();
  // Slower, and wrong in fewer places by more: right in the mean of squares.
  results.records.at("lights=100 culling=none").check->error.mse = 0.125;
  results.records.at("lights=100 culling=tiles").check->error.mse = 0.25;
  results.records.at("lights=100 culling=none").check->error.mean_signed = -0.5;
  results.records.at("lights=100 culling=tiles").check->error.mean_signed = 0.25;
  const ScaleSummary summary = summarizeScale(results);
  const std::vector<std::string>&slow = summary.points[2].fronts, &fast = summary.points[3].fronts;
  EXPECT_EQ(slow, std::vector<std::string>{"mse"});
  for (const auto& [name, figure] : kImageMetrics)
    EXPECT_EQ(std::count(fast.begin(), fast.end(), name), std::string("psnr") == name ? 0 : 1) << name;
  const TemporaryFolder folder;
  EXPECT_EQ(nlohmann::json::parse(pageData(summary, folder.path().string(), ""))["points"][2]["fronts"],
            nlohmann::json{"mse"});
}

/// Ways to make shadows, each nearer to its truth and faster than the next.
ScaleResults shadowResults() {
  ScaleResults results{madeUpExperiment(), {madeUpMachine("one")}, {}};
  ScaleDescription& description = results.description;
  description.axes = {{"shadows", {"off", "hard", "pcf", "exact"}}};
  description.points.clear();
  for (const std::uint64_t lights : description.lights)
    for (std::size_t i = 0; i < 4; ++i) {
      description.points.push_back({lights, {description.axes[0].values[i]}});
      PointRecord& record = results.records[pointName(description, description.points.back())];
      record.check = madeUpCheck(std::to_string(i), 1e-8 * std::pow(10, double(i)));
      record.runs[0] = record.runs[1] = madeUpRun(1, 1 + double(i));
    }
  return results;
}

TEST(ScaleSummary, NoFrontIsDrawnAcrossTruths) {
  const ScaleSummary summary = summarizeScale(shadowResults());
  ASSERT_EQ(summary.points.size(), 8u);
  for (std::size_t i = 0; i < 8; ++i) {
    // Without shadows the picture is fast and near to a truth without any, which says nothing of the others.
    EXPECT_EQ(summary.points[i].truth, i % 4 == 0 ? "no shadows" : "shadows by rays");
    EXPECT_EQ(summary.points[i].front, i % 4 < 2) << i;
  }
  const std::string csv = scaleCsv(summary);
  EXPECT_NE(csv.find(",list_map,truth,"), std::string::npos) << csv;
  EXPECT_NE(csv.find(",no shadows,"), std::string::npos) << csv;
  const TemporaryFolder folder;
  const auto json = nlohmann::json::parse(pageData(summary, folder.path().string(), "luciole scale"));
  EXPECT_EQ(json["points"][0]["truth"], "no shadows");
  EXPECT_EQ(json["points"][1]["truth"], "shadows by rays");
}

TEST(ScaleSummary, PointsWithoutCheckOrRunAreIncompleteAndLeftOut) {
  ScaleResults results = madeUpResults();
  results.records["lights=1 culling=none"].check.reset();
  results.records["lights=1 culling=tiles"].runs.clear();
  results.records.erase("lights=100 culling=none");
  const ScaleSummary summary = summarizeScale(results);
  ASSERT_EQ(summary.points.size(), 1u);
  EXPECT_EQ(summary.points[0].point.lights, 100u);
  EXPECT_EQ(summary.incomplete.size(), 4u);
}

TEST(ScaleSummary, EachStageOfEachVariantHasItsGrowth) {
  ScaleResults results{madeUpExperiment(), {}, {}};
  results.description.lights = {1, 10, 100, 1000, 10000};
  results.description.points.clear();
  results.description.repeats = 1;
  for (const std::uint64_t lights : results.description.lights)
    for (const char* value : {"none", "tiles"}) {
      results.description.points.push_back({lights, {value}});
      PointRecord& record =
          results.records[pointName(results.description, results.description.points.back())];
      record.check = madeUpCheck("a", 0);
      record.runs[0] = madeUpRun(0.01 * double(lights), 5);
    }
  const ScaleSummary summary = summarizeScale(results);
  ASSERT_EQ(summary.growth.size(), 6u);
  EXPECT_EQ(summary.growth[0].stage, "total");
  EXPECT_EQ(summary.growth[1].stage, "cull");
  EXPECT_EQ(summary.growth[4].values, std::vector<std::string>{"tiles"});
  ASSERT_TRUE(summary.growth[0].growth.fit);
  EXPECT_NEAR(summary.growth[0].growth.fit->c, 1, 1e-5);
  EXPECT_NEAR(summary.growth[0].growth.fit->a, 5, 1e-4);
  EXPECT_FALSE(summary.growth[2].growth.fit);  // shade: 5 ms whatever the lights
  const auto json = nlohmann::json::parse(growthJson(summary));
  EXPECT_EQ(json["growth"].size(), 6u);
  EXPECT_TRUE(json["growth"][0]["reason"].is_null());
  EXPECT_NEAR(json["growth"][0]["c"].get<double>(), 1, 1e-5);
  for (const char* name : {"a", "b", "c", "c_low", "c_high"})
    EXPECT_TRUE(json["growth"][2][name].is_null()) << name;
  EXPECT_EQ(json["growth"][2]["reason"], "no growth beyond noise");
}

TEST(ScaleSummary, BrokenBoundsAreToldByPoint) {
  ScaleResults results = madeUpLightErrors();
  EXPECT_TRUE(summarizeScale(results).violations.empty());
  results.records.at("lights=100 field=box light-error=1/16").check->bounds->violations = 2;
  const ScaleSummary summary = summarizeScale(results);
  ASSERT_EQ(summary.violations.size(), 1u);
  EXPECT_EQ(summary.violations[0],
            "lights=100 field=box light-error=1/16: 2 of 48 values are wrong by more than their bounds");
  const auto page = nlohmann::json::parse(pageData(summary, "", ""));
  EXPECT_EQ(page["violations"][0], summary.violations[0]);
  EXPECT_EQ(page["points"][5]["bounds"]["violations"], 2);
}

TEST(ScaleSummary, IntervalsAreBrokenWhereTheyHoldLessOftenThanStated) {
  ScaleResults results = madeUpLightErrors();
  KeptBounds& bounds = *results.records.at("lights=100 field=box light-error=1/16").check->bounds;
  bounds.confidence = 0.9;
  bounds.violations = 6;
  bounds.held = 0.875;
  EXPECT_TRUE(summarizeScale(results).violations.empty()) << "2 of 16 pixels";
  bounds.held = 0.25;
  const ScaleSummary summary = summarizeScale(results);
  ASSERT_EQ(summary.violations.size(), 1u);
  EXPECT_EQ(
      summary.violations[0],
      "lights=100 field=box light-error=1/16: 25.00 % of 16 pixels are within intervals that shall hold "
      "for 90 %");
}

TEST(ScaleFiles, BoundsAreInTheLastColumnsWhereThereAreAny) {
  const ScaleSummary summary = summarizeScale(madeUpLightErrors());
  std::istringstream lines(scaleCsv(summary));
  std::string head, exact, bounded;
  std::getline(lines, head);
  std::getline(lines, exact);
  for (int i = 0; i < 4; ++i) std::getline(lines, bounded);
  EXPECT_TRUE(
      head.ends_with(",truth,max_bound,mean_bound,max_error,mean_error,max_used,mean_used,"
                     "held,stated,bounded_values,violations,bound_map"))
      << head;
  EXPECT_TRUE(exact.ends_with(",field box,,,,,,,,,,,")) << exact;
  EXPECT_TRUE(
      bounded.ends_with(",field box,0.25,0.125,0.125,0.015625,0.5,0.125,1,1,48,0,pictures/bounds.png"))
      << bounded;
  const auto page = nlohmann::json::parse(pageData(summary, "", ""));
  EXPECT_TRUE(page["points"][0]["bounds"].is_null());
  EXPECT_EQ(page["points"][4]["bounds"]["max_error"], 0.125);
}

TEST(ScaleFiles, GrowthFromTwoCountsIsAReasonAndNoNumbers) {
  const ScaleSummary summary = summarizeScale(madeUpResults());
  const auto growth = nlohmann::json::parse(growthJson(summary))["growth"];
  EXPECT_EQ(nlohmann::json::parse(pageData(summary, "", ""))["growth"], growth);
  for (const auto& row : growth) {
    for (const char* name : {"a", "b", "c", "c_low", "c_high"}) EXPECT_TRUE(row[name].is_null()) << row;
    EXPECT_EQ(row["reason"], "too few numbers of lights: 2 of 5") << row;
  }
}

TEST(ScaleFiles, CsvHasALineForEachPointAndQuotesWhatNeedsIt) {
  ScaleResults results = madeUpResults();
  // A value with what would end a cell, a quote or a line.
  const std::string odd = "a,\"b\"";
  results.description.axes[0].values[0] = odd;
  for (ScalePoint& point : results.description.points)
    if (point.values[0] == "none") {
      const PointRecord record = results.records.at(pointName(results.description, point));
      point.values[0] = odd;
      results.records[pointName(results.description, point)] = record;
    }
  const std::string csv = scaleCsv(summarizeScale(results));
  std::istringstream lines(csv);
  std::string head, first;
  std::getline(lines, head);
  std::getline(lines, first);
  EXPECT_NE(
      head.find(",checked_pixels,max_abs,mean_abs,max_relative,mean_relative,mean_signed,mse,rmse,psnr,"
                "relmse,mape,smape,p99_abs,p999_abs,times_first,times_first_low,times_first_high,front,"),
      std::string::npos)
      << head;
  EXPECT_EQ(head.rfind("lights,culling,runs,ms,ms_low,ms_high,cull_ms,cull_ms_low,cull_ms_high,shade_ms", 0),
            0u)
      << head;
  EXPECT_EQ(
      first.rfind("1,\"a,\"\"b\"\"\",2,12,11.5,12.5,2,1.5,2.5,10,10,10,1.5,320,100,32,40,1000,2000,16,0.5,"
                  "0.25,0,0,0,0,0.375,0,0.75,0,1,0,0,,,,0,pictures/0.png,",
                  0),
      0u)
      << first;
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 5);
}

TEST(ScaleFiles, PageSaysWhyAFigureIsNull) {
  ScaleResults results = madeUpResults();
  PointRecord& record = results.records["lights=1 culling=none"];
  record.check->reach = record.check->error.max_abs = HUGE_VAL;
  results.records["lights=1 culling=tiles"].check->error = {.psnr = HUGE_VAL};
  const TemporaryFolder folder;
  const std::string page = pageData(summarizeScale(results), folder.path().string(), "luciole scale");
  EXPECT_EQ(page.find("nan"), std::string::npos);
  const auto json = nlohmann::json::parse(page);
  EXPECT_TRUE(json["points"][0]["reach"].is_null());
  EXPECT_EQ(json["points"][0]["reasons"]["reach"], "a light without a range reaches everywhere");
  EXPECT_TRUE(json["points"][0]["error"]["max_abs"].is_null());
  EXPECT_EQ(json["points"][0]["reasons"]["max_abs"], "a pixel is not finite");
  EXPECT_TRUE(json["points"][1]["error"]["psnr"].is_null());
  EXPECT_EQ(json["points"][1]["reasons"], (nlohmann::json{{"psnr", "no checked pixel is wrong"}}));
  EXPECT_FALSE(json["points"][2].contains("reasons"));
}

TEST(ScaleFiles, PageDoesNotEmbedWhatALinkOutOfTheFolderNames) {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder / "run/pictures");
  std::ofstream(folder / "secret.png") << "secret";
  std::filesystem::create_symlink("../../secret.png", folder / "run/pictures/0.png");
  EXPECT_THROW(pageData(summarizeScale(madeUpResults()), folder / "run", "luciole scale"), InputError);
}

TEST(ScaleFiles, PageDataHoldsEachPictureOnceAsItsBytes) {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder / "pictures");
  const std::string bytes("\x89PNG\0\xff", 6);
  // All alike but one, and one is missing.
  for (const char* name : {"0.png", "1.png", "0-error.png", "1-error.png", "2.png"})
    std::ofstream(folder / (std::string("pictures/") + name), std::ios::binary) << bytes;
  std::ofstream(folder / "pictures/3.png", std::ios::binary) << "x";
  ScaleResults results = madeUpResults();
  results.description.scene = "bad \xff name";
  const auto json =
      nlohmann::json::parse(pageData(summarizeScale(results), folder.path().string(), "luciole scale"));
  ASSERT_EQ(json["pictures"].size(), 2u);
  EXPECT_EQ(json["pictures"][0], "data:image/png;base64,eA==");
  EXPECT_EQ(json["pictures"][1], "data:image/png;base64,iVBORwD/");
  EXPECT_EQ(json["points"][0]["picture"], 1);
  EXPECT_EQ(json["points"][1]["error_map"], 1);
  EXPECT_EQ(json["points"][3]["picture"], 0);
  EXPECT_TRUE(json["points"][3]["tile_map"].is_null());
  EXPECT_EQ(json["incomplete"], 1);
  EXPECT_EQ(json["points"][0]["milliseconds"]["median"], 12);
  EXPECT_EQ(json["machine"]["processor"], "one");
}

}  // namespace
}  // namespace luciole::test
