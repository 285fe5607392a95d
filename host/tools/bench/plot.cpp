#include "tools/bench/plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <vector>

#include "tools/bench/light_errors.hpp"
#include "tools/figures/log_axis.hpp"
#include "tools/figures/svg_plot.hpp"

namespace luciole {
namespace {

constexpr glm::dvec2 kWide(728, 380);  ///< a panel across the plot, pixels

/// The rows from fast to slow.
std::vector<BenchRow> sortedRows(const BenchGroup& group) {
  std::vector<BenchRow> rows = group.rows;
  std::stable_sort(rows.begin(), rows.end(),
                   [](const BenchRow& a, const BenchRow& b) { return a.time.median < b.time.median; });
  return rows;
}

PlotPoint pointOf(const BenchRow& row) {
  const glm::dvec2 at(row.time.median, row.error.mean_abs * k8BitSteps), spread(row.time.spread, 0);
  return {at, at - spread, at + spread, row.variant.name};
}

/// The points on the front, from fast to slow, whose error is smaller than that of all before. The others are
/// as fast within the spread, and would make the line go back and forth.
std::vector<PlotPoint> frontLine(const std::vector<BenchRow>& rows) {
  std::vector<PlotPoint> line;
  for (const BenchRow& row : rows) {
    const glm::dvec2 at = pointOf(row).at;
    if (row.front && (line.empty() || at.y < line.back().at.y)) line.push_back({at, at, at});
  }
  return line;
}

PlotPanel groupPanel(const BenchGroup& group, int repeats) {
  const std::vector<BenchRow> rows = sortedRows(group);
  PlotSeries line{"Pareto front", "#e69f00", PlotMarker::kNone, PlotLine::kSteps, "", frontLine(rows)};
  PlotSeries front{"on it", "#d55e00", PlotMarker::kDot};
  PlotSeries beaten{"beaten", "#0072b2", PlotMarker::kCircle};
  PlotSeries usual{"default", "#000000", PlotMarker::kRing};
  for (const BenchRow& row : rows) {
    PlotPoint point = pointOf(row);
    if (row.variant.is_default) usual.points.push_back({point.at, point.at, point.at, point.label});
    if (row.variant.is_default) point.label.clear();
    (row.front ? front : beaten).points.push_back(point);
  }
  PlotPanel panel;
  panel.title = group.group.name;
  panel.x = {fmt::format("time, median of {} and half the quartiles' distance", repeats), timeTick};
  panel.y = {"mean error, 8-bit steps", errorTick};
  panel.series = {beaten, line, front, usual};
  return panel;
}

const SpeedCell& cellOf(const SpeedTable& table, const SpeedRow& row, const std::string& key) {
  const auto column = std::find_if(table.columns.begin(), table.columns.end(),
                                   [&](const SpeedColumn& one) { return one.key == key; });
  return row.cells[std::size_t(column - table.columns.begin())];
}

/// What a light error of some lights promises, or how wrong it is, over time: for each placement a line
/// through its errors. Rows without bounds are left out.
std::vector<PlotSeries> lightErrorSeries(const SpeedTable& table, double lights, const std::string& key,
                                         const std::string& what, PlotMarker marker,
                                         const std::string& dash) {
  std::vector<PlotSeries> all;
  for (const SpeedRow& row : table.rows) {
    const double* steps = std::get_if<double>(&cellOf(table, row, key));
    if (std::get<double>(cellOf(table, row, "lights")) != lights || !steps) continue;
    const std::size_t comma = row.name.find(", ");  // "box, 1/256"
    const std::string name = row.name.substr(0, comma) + ", " + what;
    if (all.empty() || all.back().name != name)
      all.push_back({name, kPlotColors[1 + all.size()], marker, PlotLine::kStraight, dash});
    const Repeated& time = std::get<Repeated>(cellOf(table, row, "milliseconds"));
    const glm::dvec2 at(time.median, *steps), spread(time.spread, 0);
    all.back().points.push_back({at, at - spread, at + spread, row.name.substr(comma + 2)});
  }
  return all;
}

/// Of the most lights.
PlotPanel lightErrorPanel(const SpeedTable& table, int repeats) {
  const double lights = std::get<double>(cellOf(table, table.rows.back(), "lights"));
  PlotPanel panel;
  panel.title = fmt::format("light error, {} lights", countTick(lights));
  panel.x = {fmt::format("time, median of at most {} and half the quartiles' distance", repeats), timeTick};
  panel.y = {"largest of the picture, 8-bit steps", errorTick};
  panel.series = lightErrorSeries(table, lights, "max_bound_steps", "bound", PlotMarker::kDot, "");
  for (PlotSeries& series :
       lightErrorSeries(table, lights, "max_error_steps", "true error", PlotMarker::kCircle, "4 4"))
    panel.series.push_back(std::move(series));
  return panel;
}

}  // namespace

std::string benchPlot(const BenchResult& result) {
  Plot plot{fmt::format("Speed against error: {}, {} × {}", result.scene, result.width, result.height), {}};
  for (const BenchGroup& group : result.groups) {
    if (!haveOneTruth(group.group)) continue;
    PlotPanel panel = groupPanel(group, result.repeats);
    // The first group is across the top, with the legend for all; the others are side by side under it.
    panel.has_legend = plot.rows.empty();
    panel.size = panel.has_legend ? kWide : glm::dvec2(384, 300);
    if (plot.rows.size() < 2) plot.rows.emplace_back();
    plot.rows.back().push_back(panel);
  }
  for (const SpeedTable& table : result.speed) {
    if (table.name != kLightErrors || table.rows.empty()) continue;
    PlotPanel panel = lightErrorPanel(table, result.repeats);
    panel.size = kWide;
    plot.rows.push_back({panel});
  }
  return svgPlot(plot);
}

}  // namespace luciole
