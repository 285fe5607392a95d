#include "tools/bench/report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tools/figures/made_up_result.hpp"
#include "tools/figures/text_table.hpp"

namespace luciole::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// The lines that hold `text`.
std::vector<std::string> linesWith(const std::string& all, const std::string& text) {
  std::vector<std::string> found;
  std::istringstream lines(all);
  for (std::string line; std::getline(lines, line);)
    if (line.find(text) != std::string::npos) found.push_back(line);
  return found;
}

TEST(BenchTable, ARowSaysTimeSpreadErrorsAndFront) {
  const std::string table = benchTable(madeUpResult());
  const auto usual = linesWith(table, "usual (default)"), slow = linesWith(table, "| slow ");
  ASSERT_EQ(usual.size(), 1u);
  ASSERT_EQ(slow.size(), 1u);
  // In steps: mean 0.001, largest 4 times that, signed −half; shares of 2: that / 255 / 2. relMSE twice the
  // mean's square, SMAPE three times the mean, in linear units.
  EXPECT_THAT(usual[0], AllOf(HasSubstr("| 10.0 |"), HasSubstr("± 5 %"), HasSubstr("4.0e-03"),
                              HasSubstr("1.0e-03"), HasSubstr("-5.0e-04"), HasSubstr("7.8e-06"),
                              HasSubstr("2.0e-06"), HasSubstr("| 3.1e-11 | 1.2e-05 |"), HasSubstr("* |")));
  EXPECT_THAT(slow[0], Not(HasSubstr("*")));
}

TEST(BenchTable, ColumnsStandUnderOneAnother) {
  std::vector<std::size_t> widths;
  for (const std::string& line : linesWith(benchTable(madeUpResult()), "|"))
    widths.push_back(shownWidth(line));
  ASSERT_EQ(widths.size(), 13u);  // three heads of two lines, and rows
  for (std::size_t i = 1; i < 5; ++i) EXPECT_EQ(widths[i], widths[0]) << i;
  for (std::size_t i = 6; i < 9; ++i) EXPECT_EQ(widths[i], widths[5]) << i;
  for (std::size_t i = 10; i < 13; ++i) EXPECT_EQ(widths[i], widths[9]) << i;
}

TEST(BenchTable, SaysWhatTheTruthOfTheSamplesIsWorth) {
  const auto lines = linesWith(benchTable(madeUpResult()), "the whole picture");
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_THAT(lines[0], HasSubstr("1.0e-02"));
}

TEST(BenchTable, ATableOfSpeedHasAFigureOrADashAndItsReasonInEachCell) {
  const std::string table = benchTable(madeUpResult());
  EXPECT_THAT(table, HasSubstr("a stage: what it costs."));
  EXPECT_EQ(linesWith(table, "| one "), std::vector<std::string>{"| one     | 12.35 ± 10 % |       7 |"});
  EXPECT_EQ(linesWith(table, "| two "), std::vector<std::string>{"| two     |   0.00 ± 0 % |       – |"});
  EXPECT_EQ(linesWith(table, "–: "), std::vector<std::string>{"–: nobody counted."});
}

TEST(BenchReport, AnEstimateIsMarkedAsOneAndFailuresAreInTheJson) {
  BenchResult result = madeUpResult();
  result.speed[0].rows[1].cells[0] = Estimate{1234.567};
  result.speed[0].failures = {"two is wrong"};
  EXPECT_THAT(linesWith(benchTable(result), "| two ")[0], HasSubstr(" ≈ 1234.57 |"));
  const auto json = nlohmann::json::parse(benchJson(result))["speed"][0];
  EXPECT_EQ(json["rows"][1]["milliseconds"], (nlohmann::json{{"estimate", 1234.567}}));
  EXPECT_EQ(json["failures"], nlohmann::json::array({"two is wrong"}));
  EXPECT_FALSE(nlohmann::json::parse(benchJson(madeUpResult()))["speed"][0].contains("failures"));
}

TEST(BenchJson, ATableOfSpeedHasItsFiguresByKey) {
  const auto json = nlohmann::json::parse(benchJson(madeUpResult()))["speed"][0];
  EXPECT_EQ(json["name"], "a stage");
  EXPECT_EQ(json["measured"], "what it costs");
  EXPECT_EQ(json["rows"][0], (nlohmann::json{{"name", "one"},
                                             {"milliseconds", {{"median", 12.345}, {"spread", 1.2345}}},
                                             {"entries", 7.0}}));
  EXPECT_TRUE(json["rows"][1].at("entries").is_null());
  EXPECT_EQ(json["rows"][1]["reasons"]["entries"], "nobody counted");
}

TEST(BenchJson, HoldsEveryRowWithItsSettingsTimeAndErrors) {
  const auto json = nlohmann::json::parse(benchJson(madeUpResult()));
  EXPECT_EQ(json["machine"]["processor"], "A processor");
  EXPECT_EQ(json["machine"]["device"]["driver"], "1.2");
  EXPECT_EQ(json["scene"]["name"], "it's a scene.json");
  EXPECT_EQ(json["image"]["width"], 64);
  EXPECT_EQ(json["repeats"], 5);
  ASSERT_EQ(json["groups"].size(), 2u);
  ASSERT_EQ(json["groups"][0]["rows"].size(), 3u);
  const auto& row = json["groups"][0]["rows"][0];
  EXPECT_EQ(row["name"], "usual");
  EXPECT_EQ(row["default"], true);
  EXPECT_EQ(row["front"], true);
  EXPECT_EQ(row["settings"]["lanes"], 8);
  EXPECT_EQ(row["settings"]["culling"], "tiles");
  EXPECT_EQ(row["settings"]["tile"], 4);
  EXPECT_EQ(row["settings"]["shadows"], "hard");
  EXPECT_EQ(row["milliseconds"]["median"], 10);
  EXPECT_EQ(row["milliseconds"]["spread"], 0.5);
  EXPECT_DOUBLE_EQ(row["error"]["steps"]["max"], 4e-3);
  EXPECT_DOUBLE_EQ(row["error"]["steps"]["mean"], 1e-3);
  EXPECT_DOUBLE_EQ(row["error"]["steps"]["signed"], -5e-4);
  EXPECT_DOUBLE_EQ(row["error"]["relative"]["mean"], 1e-3 / 255 / 2);
  EXPECT_DOUBLE_EQ(row["error"]["relmse"], 2 * std::pow(1e-3 / 255, 2));
  EXPECT_DOUBLE_EQ(row["error"]["smape"], 3e-3 / 255);
}

TEST(BenchJson, AnInfiniteErrorIsNull) {
  BenchResult result = madeUpResult();
  result.groups[0].rows[0].error.max_abs = std::numeric_limits<double>::infinity();
  const auto json = nlohmann::json::parse(benchJson(result));
  EXPECT_TRUE(json["groups"][0]["rows"][0]["error"]["steps"]["max"].is_null());
  EXPECT_EQ(json["groups"][0]["rows"][0]["error"]["steps"]["reason"],
            "a pixel of one picture alone is not finite");
}

TEST(BenchReport, OfABlackTruthNoErrorIsAShare) {
  BenchResult result = madeUpResult();
  for (BenchRow& row : result.groups[0].rows) row.brightest = 0;
  const std::string table = benchTable(result);
  EXPECT_EQ(linesWith(table, "–: "),
            (std::vector<std::string>{"–: the truth is black, of which no error is a share.",
                                      "–: nobody counted."}));
  EXPECT_EQ(table.find("inf"), std::string::npos) << table;
  const auto error = nlohmann::json::parse(benchJson(result))["groups"][0]["rows"][0]["error"];
  EXPECT_TRUE(error["relative"]["mean"].is_null());
  EXPECT_EQ(error["relative"]["reason"], "the truth is black, of which no error is a share");
  EXPECT_FALSE(error["steps"].contains("reason"));
}

}  // namespace
}  // namespace luciole::test
