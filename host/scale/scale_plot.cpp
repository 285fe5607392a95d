#include "scale/scale_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <iterator>

#include "figures/log_axis.hpp"
#include "figures/svg_plot.hpp"

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

/// The variant that is fastest with the most lights that were measured.
const std::vector<std::string>& bestVariant(const ScaleSummary& summary) {
  const PointSummary* best = &summary.points.front();
  for (const PointSummary& point : summary.points) {
    const bool has_more = point.point.lights > best->point.lights;
    const bool is_faster =
        point.point.lights == best->point.lights && point.milliseconds.median < best->milliseconds.median;
    if (has_more || is_faster) best = &point;
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

std::vector<PlotSeries> variantSeries(const ScaleSummary& summary) {
  std::vector<PlotSeries> all;
  for (const PointSummary& point : summary.points)
    seriesNamed(all, variantName(summary.description, point.point.values))
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

}  // namespace

std::string scalePlot(const ScaleSummary& summary) {
  const std::vector<PlotSeries> variants = variantSeries(summary);
  const std::vector<std::string>& best = bestVariant(summary);
  const std::string name = variantName(summary.description, best);
  Plot plot{"Time against lights: " + summary.description.scene, {{}}};
  plot.rows[0].push_back(panelOf((name.empty() ? "" : name + ", ") + "by stage", stageSeries(summary, best)));
  if (variants.size() > 1) plot.rows[0].push_back(panelOf("the whole picture, by variant", variants));
  return svgPlot(plot);
}

}  // namespace luciole
