#include "experiment/plot.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "error.hpp"
#include "experiment/gnuplot.hpp"
#include "experiment/made_up_result.hpp"
#include "shared_files.hpp"

namespace luciole::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class Plot : public testing::Test {
 protected:
  void SetUp() override { LUCIOLE_NEEDS_PROGRAM("gnuplot", "gnuplot-nox"); }
};

TEST(LogTicks, ArePowersOfTenOverDecadesAndFinerOverLess) {
  EXPECT_THAT(logTicks(0.5, 200), ElementsAre(1, 10, 100));
  EXPECT_THAT(logTicks(8, 120), ElementsAre(10, 30, 100));
  EXPECT_THAT(logTicks(18, 60), ElementsAre(20, 30, 50));
}

TEST(LogTicks, LieInsideTheRange) {
  for (const double low : {1.1e-7, 4e-3, 0.97, 1.0, 2.6, 31.0, 999.0, 1e4})
    for (const double ratio : {1.3, 2.0, 7.0, 1000.0}) {
      const std::vector<double> ticks = logTicks(low, low * ratio);
      EXPECT_GE(ticks.size(), 1u) << low << " " << ratio;
      for (const double tick : ticks) EXPECT_TRUE(tick >= low && tick <= low * ratio) << tick;
    }
}

TEST(GnuplotString, CanNotBreakOutOfItsQuotes) {
  EXPECT_EQ(gnuplotString("it's"), "'it''s'");
  EXPECT_EQ(gnuplotString("a\nsystem 'ls'\\"), "'a?system ''ls''\\'");
}

TEST_F(Plot, ShowsEveryRowTheFrontTheDefaultAndUnits) {
  const std::string svg = benchPlot(madeUpResult());
  EXPECT_EQ(svg.rfind("<?xml", 0), 0u);
  EXPECT_THAT(svg, HasSubstr("</svg>"));
  for (const char* text : {"usual", "rough", "slow", "samples 1", "samples 2", "Pareto front", "default",
                           "milliseconds", "8-bit steps", "it's a scene.json"})
    EXPECT_THAT(svg, HasSubstr(text));
}

TEST_F(Plot, ErrorsOfZeroAndTimesWithinTheirOwnSpreadAreDrawn) {
  BenchResult result = madeUpResult();
  result.groups[0].rows[0].error.mean_abs = 0;
  result.groups[0].rows[1].time.spread = 2 * result.groups[0].rows[1].time.median;
  EXPECT_THAT(benchPlot(result), HasSubstr("</svg>"));
}

TEST_F(Plot, AComplaintOfGnuplotIsAnError) {
  try {
    runGnuplot("plot nonsense(");
    FAIL() << "no error";
  } catch (const MachineError& error) {
    EXPECT_THAT(error.what(), HasSubstr("gnuplot: "));
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
  }
}

}  // namespace
}  // namespace luciole::test
