#include "tools/scale/scale_plot.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tools/scale/made_up_experiment.hpp"

namespace luciole::test {
namespace {

using testing::HasSubstr;
using testing::Not;

/// Shading takes 2 ms a light, or 9 without culling, which takes 0.001 ms.
ScaleSummary summaryOf(std::size_t variants) {
  ScaleResults results{madeUpExperiment(), {}, {}};
  results.description.axes[0].values.resize(variants);
  std::erase_if(results.description.points,
                [&](const ScalePoint& point) { return variants == 1 && point.values[0] != "none"; });
  for (const ScalePoint& point : results.description.points) {
    PointRecord& record = results.records[pointName(results.description, point)];
    record.check = madeUpCheck("a", 0.1);
    record.runs[0] = madeUpRun(0.001, (point.values[0] == "none" ? 9 : 2) * double(point.lights));
  }
  return summarizeScale(results);
}

TEST(ScalePlot, ShowsTheFastestVariantsStagesThatMatterAndAllByName) {
  const std::string svg = scalePlot(summaryOf(2));
  EXPECT_THAT(svg, HasSubstr("<svg"));
  for (const char* text :
       {">shade<", ">total<", ">culling none<", ">culling tiles<", ">lights<", ">culling tiles, by stage<"})
    EXPECT_THAT(svg, HasSubstr(text));
  EXPECT_THAT(svg, Not(HasSubstr(">cull<")));
}

TEST(ScalePlot, OneVariantHasOnePanelAndThePictureNamesTheScene) {
  const std::string svg = scalePlot(summaryOf(1));
  EXPECT_THAT(svg, HasSubstr("Time against lights: halls/a, b.json"));
  EXPECT_THAT(svg, Not(HasSubstr("by variant")));
}

TEST(ScalePlot, BoundsAndErrorsOfTheMostLightsHaveALineForEachOtherChoice) {
  const std::string svg = scalePlot(summarizeScale(madeUpLightErrors()));
  for (const char* text : {">largest bound and error at 100 lights<", ">mean bound and error at 100 lights<",
                           ">field box, bound<", ">field ball, true error<", ">1/4<", ">1/16<"})
    EXPECT_THAT(svg, HasSubstr(text));
  EXPECT_THAT(scalePlot(summaryOf(2)), Not(HasSubstr("bound")));
}

TEST(ScalePlot, NamesHowEachVariantGrows) {
  ScaleSummary summary = summaryOf(2);
  for (StageGrowth& row : summary.growth) row.growth.fit = GrowthFit{.b = 1, .c = 0.456};
  const std::string svg = scalePlot(summary);
  EXPECT_THAT(svg, HasSubstr(">culling none: c = 0.46<"));
  EXPECT_THAT(svg, HasSubstr("ms = a + b · lights^c"));
}

}  // namespace
}  // namespace luciole::test
