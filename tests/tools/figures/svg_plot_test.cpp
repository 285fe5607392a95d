#include "tools/figures/svg_plot.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <regex>
#include <string>
#include <utility>
#include <vector>

#include "tools/figures/log_axis.hpp"
#include "tools/scale/browser.hpp"

namespace luciole::test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

Plot plotOf(std::vector<PlotSeries> series, const std::string& title = "a plot") {
  return {title, {{{"a panel", {400, 300}, {"lights", countTick}, {"time", timeTick}, std::move(series)}}}};
}

/// The centres of all dots.
std::vector<glm::dvec2> dots(const std::string& svg) {
  static const std::regex kDot("<circle cx=\"([^\"]*)\" cy=\"([^\"]*)\"");
  std::vector<glm::dvec2> found;
  for (std::sregex_iterator dot(svg.begin(), svg.end(), kDot), end; dot != end; ++dot)
    found.emplace_back(std::stod((*dot)[1]), std::stod((*dot)[2]));
  return found;
}

TEST(SvgPlot, PutsValuesWhereLogarithmicAxesHaveThem) {
  const std::string svg =
      svgPlot(plotOf({{.points = {{{1, 10}, {}, {}}, {{10, 100}, {}, {}}, {{100, 1}, {}, {}}}}}));
  const std::vector<glm::dvec2> at = dots(svg);
  ASSERT_EQ(at.size(), 3u);
  // Written to a hundredth of a pixel.
  EXPECT_NEAR(at[1].x - at[0].x, at[2].x - at[1].x, 0.021);
  EXPECT_NEAR(at[0].y - at[1].y, at[2].y - at[0].y, 0.021);
  EXPECT_GT(at[1].x, at[0].x);
  EXPECT_LT(at[1].y, at[0].y);  // up
  // The grid's line at 10 goes through the middle one, and is labelled so.
  EXPECT_THAT(svg, HasSubstr(fmt::format("M{:g} ", at[1].x)));
  EXPECT_THAT(svg, HasSubstr(">10</text>"));
  EXPECT_THAT(svg, HasSubstr(">10 ms</text>"));
}

TEST(SvgPlot, ScalesWithThePageThatShowsIt) {
  const std::string svg = svgPlot(plotOf({{.points = {{{1, 10}, {}, {}}}}}));
  std::smatch size;
  ASSERT_TRUE(std::regex_search(
      svg, size, std::regex("width=\"(\\d+)\" height=\"(\\d+)\" viewBox=\"0 0 (\\d+) (\\d+)\"")));
  EXPECT_EQ(size[1], size[3]);
  EXPECT_EQ(size[2], size[4]);
  EXPECT_THAT(svg, HasSubstr("font-family=\"sans-serif\""));
}

TEST(SvgPlot, TextsCanNotBreakOutOfTheirPlaces) {
  const std::string hostile = "</text><script>&\"'\x01\xff\xed\xa0\x80 \uFFFF é";
  const std::string svg =
      svgPlot(plotOf({{.name = hostile, .points = {{{1, 10}, {}, {}, hostile}}}}, hostile));
  EXPECT_THAT(svg, Not(HasSubstr("<script")));
  EXPECT_THAT(svg, HasSubstr("&lt;/text&gt;&lt;script&gt;&amp;&quot;'\uFFFD\u00FF\u00ED"));
  EXPECT_THAT(svg, HasSubstr(" \uFFFD é"));
  EXPECT_EQ(svg.find('\x01'), std::string::npos);
  EXPECT_EQ(svg.find('\xff'), std::string::npos);
}

TEST(SvgPlot, ZerosBarsBeyondZeroAndSeriesWithoutPointsAreDrawn) {
  for (const std::vector<PlotPoint>& points :
       std::vector<std::vector<PlotPoint>>{{},
                                           {{{0, 0}, {}, {}}},
                                           {{{1, 0}, {-1, 0}, {3, 0}}, {{10, 2}, {}, {}}},
                                           {{{5, 5}, {5, 5}, {5, 5}}}}) {
    const std::string svg = svgPlot(plotOf({{.name = "a", .line = PlotLine::kSteps, .points = points}}));
    EXPECT_THAT(svg, HasSubstr("</svg>"));
    EXPECT_THAT(svg, Not(HasSubstr("nan")));
    EXPECT_THAT(svg, Not(HasSubstr("inf")));
  }
}

/// Names in a crowd, along a front of steps, some of them long.
Plot crowdedPlot() {
  PlotSeries front{
      .name = "front", .color = "#e69f00", .marker = PlotMarker::kNone, .line = PlotLine::kSteps};
  PlotSeries rows{.name = "rows & more"}, usual{.name = "usual", .marker = PlotMarker::kRing};
  for (int i = 0; i < 8; ++i) {
    const double time = 4 + 0.2 * i * i * i, error = 1e-2 * std::pow(0.25, i);
    front.points.push_back({{time, error}, {}, {}});
    rows.points.push_back(
        {{time, error}, {time * 0.9, error}, {time * 1.1, error}, "lanes 16, row " + std::to_string(i)});
    if (i < 4) rows.points.push_back({{time * 1.02, error * 1.05}, {}, {}, "close by"});
  }
  usual.points.push_back({{4, 1e-2}, {}, {}, "lanes 16, log2 8, exp2 6"});
  return plotOf({front, rows, usual});
}

TEST(SvgPlot, IsWellFormedAndItsTextsLieInsideApartAndOffTheFront) {
  LUCIOLE_NEEDS_PROGRAM("chromium", "chromium");
  Browser& browser = browserWithEmptyPage();
  const std::string svg = svgPlot(crowdedPlot());
  browser.open("<!DOCTYPE html><meta charset=\"utf-8\"><body>" + svg.substr(svg.find("<svg")));
  EXPECT_EQ(browser.evaluate("new DOMParser().parseFromString(document.querySelector('svg').outerHTML, "
                             "'image/svg+xml').querySelector('parsererror') === null"),
            true);
  EXPECT_EQ(browser.evaluate("document.querySelectorAll('.labels text').length"), 13);
  const std::string boxes =
      "const boxes = [...document.querySelectorAll('text')].map(text => ({name: text.textContent, "
      "isLabel: !!text.closest('.labels'), ...text.getBoundingClientRect().toJSON()}));";
  EXPECT_THAT(browser.evaluate("(() => {" + boxes + R"(
    const all = document.querySelector('svg').getBoundingClientRect();
    return boxes.filter(b => b.left < all.left || b.right > all.right || b.top < all.top || b.bottom > all.bottom)
      .map(b => b.name);
  })())"),
              IsEmpty());
  // Boxes have their line's leading above and below the letters: 3 pixels of it may overlap.
  EXPECT_THAT(browser.evaluate("(() => {" + boxes + R"(
    return boxes.flatMap((a, i) => boxes.slice(i + 1)
      .filter(b => a.left < b.right && b.left < a.right && a.top + 3 < b.bottom && b.top + 3 < a.bottom)
      .map(b => `${a.name} over ${b.name}`));
  })())"),
              IsEmpty());
  EXPECT_THAT(browser.evaluate("(() => {" + boxes + R"(
    const front = document.querySelector('path[stroke="#e69f00"]'), matrix = front.getScreenCTM(), struck = new Set();
    for (let at = 0; at <= front.getTotalLength(); at += 0.5) {
      const {x, y} = front.getPointAtLength(at).matrixTransform(matrix);
      for (const b of boxes)
        if (b.isLabel && x > b.left && x < b.right && y > b.top + 1 && y < b.bottom - 1) struck.add(b.name);
    }
    return [...struck];
  })())"),
              IsEmpty());
}

}  // namespace
}  // namespace luciole::test
