#include "tools/bench/plot.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tools/bench/light_errors.hpp"
#include "tools/figures/made_up_result.hpp"

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

TEST(BenchPlot, ShowsBoundsAndErrorsOfTheMostLightsOfEachPlacement) {
  BenchResult result = madeUpResult();
  result.groups.clear();
  result.speed = {{.name = kLightErrors,
                   .measured = "what bounds cost",
                   .columns = {{"lights", "", 0},
                               {"milliseconds", "", 0},
                               {"max_bound_steps", "", 0},
                               {"max_error_steps", "", 0}},
                   .rows = {{"box, 1/7", {10.0, Repeated{1, 0}, 8.0, 2.0}},
                            {"box, 1/16", {1000.0, Repeated{2, 0}, 15.0, 3.0}},
                            {"box, 1/64", {1000.0, Repeated{4, 0}, 4.0, 0.5}},
                            {"clusters, 1/16", {1000.0, Repeated{3, 0}, NoValue{"none"}, NoValue{"none"}}},
                            {"surfaces, 1/16", {1000.0, Repeated{3, 0}, 15.0, 2.0}}}}};
  const std::string svg = benchPlot(result);
  for (const char* text : {">light error, 1k lights<", ">box, bound<", ">box, true error<",
                           ">surfaces, bound<", ">1/16<", ">1/64<"})
    EXPECT_THAT(svg, HasSubstr(text));
  for (const char* text : {"clusters", ">1/7<"}) EXPECT_THAT(svg, Not(HasSubstr(text)));
}

}  // namespace
}  // namespace luciole::test
