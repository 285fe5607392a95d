#include "tools/scale/scale_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <utility>

#include "tools/figures/log_axis.hpp"
#include "tools/figures/svg_plot.hpp"

namespace luciole {
namespace {

PlotSeries& seriesNamed(std::vector<PlotSeries>& all, const std::string& name) {
  const auto known =
      std::find_if(all.begin(), all.end(), [&](const PlotSeries& series) { return series.name == name; });
  if (known != all.end()) return *known;
  return all.emplace_back(PlotSeries{name});
}

PlotPoint pointOf(std::uint64_t lights, const Quartiles& time) {
  const double x = double(lights);
  return {{x, time.median}, {x, time.low}, {x, time.high}};
}

double highest(const PlotSeries& series) {
  double most = 0;
  for (const PlotPoint& point : series.points) most = std::max(most, point.at.y);
  return most;
}

/// Luciole's variant that is fastest with the most lights that were measured.
const std::vector<std::string>& bestVariant(const ScaleSummary& summary) {
  const PointSummary* best = &summary.points.front();
  for (const PointSummary& point : summary.points) {
    if (!point.is_own) continue;
    const bool has_more = point.point.lights > best->point.lights;
    const bool is_faster =
        point.point.lights == best->point.lights && point.milliseconds.median < best->milliseconds.median;
    if (!best->is_own || has_more || is_faster) best = &point;
  }
  return best->point.values;
}

std::vector<PlotSeries> stageSeries(const ScaleSummary& summary, const std::vector<std::string>& variant) {
  std::vector<PlotSeries> all;
  for (const PointSummary& point : summary.points) {
    if (point.point.values != variant) continue;
    seriesNamed(all, kWhole).points.push_back(pointOf(point.point.lights, point.milliseconds));
    for (const StageSummary& stage : point.stages)
      seriesNamed(all, stage.name).points.push_back(pointOf(point.point.lights, stage.milliseconds));
  }
  const double least = 0.01 * highest(all.front());
  std::erase_if(all, [&](const PlotSeries& series) { return highest(series) < least; });
  return all;
}

/// A variant's name, and the exponent of its whole time (see GrowthFit) if that is known.
std::string grownName(const ScaleSummary& summary, const std::vector<std::string>& values) {
  const std::string name = variantName(summary.description, values);
  for (const StageGrowth& row : summary.growth)
    if (row.values == values && row.stage == kWhole && row.growth.fit)
      return fmt::format("{}: c = {:.2f}", name, row.growth.fit->c);
  return name;
}

std::vector<PlotSeries> variantSeries(const ScaleSummary& summary) {
  std::vector<PlotSeries> all;
  for (const PointSummary& point : summary.points)
    if (point.runs > 0)
      seriesNamed(all, grownName(summary, point.point.values))
          .points.push_back(pointOf(point.point.lights, point.milliseconds));
  return all;
}

/// A panel of these series. Its legend lists the lines in the order of their right ends, the highest first.
/// Neighbours differ in colour and in marker, so that either is enough to tell them apart.
PlotPanel panelOf(const std::string& title, std::vector<PlotSeries> series) {
  static constexpr PlotMarker kMarkers[] = {PlotMarker::kDot, PlotMarker::kSquare, PlotMarker::kTriangle,
                                            PlotMarker::kDiamond, PlotMarker::kCircle};
  static constexpr const char* kDashes[] = {"", "7 4", "2 3", "10 3 2 3"};
  std::stable_sort(series.begin(), series.end(), [](const PlotSeries& a, const PlotSeries& b) {
    return a.points.back().at.y > b.points.back().at.y;
  });
  for (std::size_t i = 0; i < series.size(); ++i) {
    series[i].color = kPlotColors[i % std::size(kPlotColors)];
    series[i].marker = kMarkers[i % std::size(kMarkers)];
    series[i].line = PlotLine::kStraight;
    series[i].dash = kDashes[i / std::size(kPlotColors) % std::size(kDashes)];
  }
  return {title, {384, 320}, {"lights", countTick}, {"time, median and quartiles", timeTick}, series};
}

/// The variant without its light error, and that light error.
struct ErrorVariant {
  std::string rest, light_error;
};

ErrorVariant withoutLightError(const ScaleDescription& description, std::vector<std::string> values) {
  std::string light_error;
  for (std::size_t i = 0; i < values.size(); ++i)
    if (description.axes[i].name == kLightErrorAxis) light_error = std::exchange(values[i], kNotThis);
  return {variantName(description, values), light_error};
}

/// A figure of the bounds of the most lights, and the same of the errors, over time: a line each through all
/// light errors. Without points where no picture has bounds.
PlotPanel boundPanel(const ScaleSummary& summary, const std::string& which, double KeptBounds::*bound,
                     double KeptBounds::*error) {
  std::vector<PlotSeries> all;
  const std::uint64_t most = summary.points.back().point.lights;
  for (const PointSummary& point : summary.points) {
    if (point.point.lights != most || !point.check.bounds) continue;
    const auto [rest, light_error] = withoutLightError(summary.description, point.point.values);
    for (const auto& [name, figure] : {std::pair("bound", bound), {"true error", error}}) {
      const Quartiles& time = point.milliseconds;
      const double y = *point.check.bounds.*figure;
      seriesNamed(all, rest.empty() ? name : fmt::format("{}, {}", rest, name))
          .points.push_back({{time.median, y}, {time.low, y}, {time.high, y}, light_error});
    }
  }
  for (PlotSeries& series : all)
    std::stable_sort(series.points.begin(), series.points.end(),
                     [](const PlotPoint& a, const PlotPoint& b) { return a.at.x < b.at.x; });
  PlotPanel panel = panelOf(fmt::format("{} at {} lights", which, countTick(double(most))), std::move(all));
  panel.x = {"time, median and quartiles", timeTick};
  panel.y = {"share of the larger of 1 and the colour", errorTick};
  return panel;
}

}  // namespace

std::string scalePlot(const ScaleSummary& summary) {
  const std::vector<PlotSeries> variants = variantSeries(summary);
  const std::vector<std::string>& best = bestVariant(summary);
  const std::string name = variantName(summary.description, best);
  const bool any_grows =
      std::any_of(summary.growth.begin(), summary.growth.end(),
                  [](const StageGrowth& row) { return row.stage == kWhole && row.growth.fit.has_value(); });
  Plot plot{"Time against lights: " + summary.description.scene, {{}}};
  plot.rows[0].push_back(panelOf((name.empty() ? "" : name + ", ") + "by stage", stageSeries(summary, best)));
  if (variants.size() > 1)
    plot.rows[0].push_back(panelOf(
        any_grows ? "the whole picture, ms = a + b · lights^c" : "the whole picture, by variant", variants));
  const bool are_bounded =
      std::any_of(summary.points.begin(), summary.points.end(), [&](const PointSummary& point) {
        return point.point.lights == summary.points.back().point.lights && point.check.bounds;
      });
  if (are_bounded) {
    plot.rows.push_back(
        {boundPanel(summary, "largest bound and error", &KeptBounds::max_bound, &KeptBounds::max_error),
         boundPanel(summary, "mean bound and error", &KeptBounds::mean_bound, &KeptBounds::mean_error)});
    plot.rows.back().front().has_legend = false;  // the other panel's is the same
  }
  return svgPlot(plot);
}

}  // namespace luciole
