#include "bench/plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <vector>

#include "figures/log_axis.hpp"
#include "figures/svg_plot.hpp"

namespace luciole {
namespace {

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

}  // namespace

std::string benchPlot(const BenchResult& result) {
  Plot plot{fmt::format("Speed against error: {}, {} × {}", result.scene, result.width, result.height), {}};
  for (const BenchGroup& group : result.groups) {
    if (!haveOneTruth(group.group)) continue;
    PlotPanel panel = groupPanel(group, result.repeats);
    // The first group is across the top, with the legend for all; the others are side by side under it.
    panel.has_legend = plot.rows.empty();
    panel.size = panel.has_legend ? glm::dvec2(728, 380) : glm::dvec2(384, 300);
    if (plot.rows.size() < 2) plot.rows.emplace_back();
    plot.rows.back().push_back(panel);
  }
  return svgPlot(plot);
}

}  // namespace luciole
