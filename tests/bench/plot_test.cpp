#include "bench/plot.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "figures/made_up_result.hpp"

namespace luciole::test {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(BenchPlot, ShowsEveryRowTheFrontTheDefaultAndUnits) {
  const std::string svg = benchPlot(madeUpResult());
  EXPECT_EQ(svg.rfind("<?xml", 0), 0u);
  EXPECT_THAT(svg, HasSubstr("</svg>"));
  for (const char* text : {">usual<", ">rough<", ">slow<", ">samples 1<", ">samples 2<", ">Pareto front<",
                           ">default<", "time, median of 5", "8-bit steps", "it's a scene.json, 64 × 36"})
    EXPECT_THAT(svg, HasSubstr(text));
}

TEST(BenchPlot, ErrorsOfZeroAreDrawnAsZeroAndTimesMayBeWithinTheirOwnSpread) {
  BenchResult result = madeUpResult();
  EXPECT_THAT(benchPlot(result), Not(HasSubstr(">0<")));
  result.groups[0].rows[0].error.mean_abs = 0;
  result.groups[0].rows[1].time.spread = 2 * result.groups[0].rows[1].time.median;
  EXPECT_THAT(benchPlot(result), HasSubstr(">0<"));
}

}  // namespace
}  // namespace luciole::test
