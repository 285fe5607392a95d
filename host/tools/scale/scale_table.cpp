#include "tools/scale/scale_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "tools/figures/text_table.hpp"

namespace luciole {
namespace {

using Cells = std::vector<std::string>;

constexpr const char* kNoFigure = "–";
constexpr std::size_t kMostRows = 40;   ///< nobody reads more
constexpr std::size_t kMostStages = 3;  ///< of a variant whose growth is told
constexpr double kLeastShare = 0.01;  ///< of the time by the most lights, that a stage's growth must come to

Cells axisNames(const ScaleDescription& description) {
  Cells names;
  for (const ScaleAxis& axis : description.axes) names.push_back(axis.name);
  return names;
}

std::string errorText(double error) {
  return std::isfinite(error) ? fmt::format("{:.1e}", error) : "not finite";
}

std::string ratioText(const PointSummary& point) {
  const std::optional<TimeRatio>& ratio = point.times_first;
  return ratio ? fmt::format("{:.3g} ({:.3g} to {:.3g})", ratio->median, ratio->low, ratio->high) : kNoFigure;
}

bool isSampled(const PointSummary& point) { return point.check.bounds && point.check.bounds->confidence < 1; }

std::string pointTable(const ScaleSummary& summary, const std::vector<PointSummary>& points) {
  Cells head{"lights"};
  for (const std::string& name : axisNames(summary.description)) head.push_back(name);
  for (const char* name :
       {"ms", "spread", "mean error", "largest", "relMSE", "SMAPE", "memory, MiB", "front"})
    head.push_back(name);
  const bool have_ratios = std::any_of(
      points.begin(), points.end(), [](const PointSummary& point) { return point.times_first.has_value(); });
  if (have_ratios) head.push_back("times the first (95 %)");
  const bool are_bounded = std::any_of(
      points.begin(), points.end(), [](const PointSummary& point) { return point.check.bounds.has_value(); });
  if (are_bounded)
    for (const char* name : {"largest bound", "mean", "error / bound, largest", "mean"}) head.push_back(name);
  const bool are_sampled = std::any_of(points.begin(), points.end(), isSampled);
  if (are_sampled) head.push_back("pixels within, %");
  // Errors compare, and a front is meaningful, only among points with the same truth.
  const bool truths_differ = std::any_of(points.begin(), points.end(), [&](const PointSummary& point) {
    return point.truth != points.front().truth;
  });
  if (truths_differ) head.push_back("truth");
  std::vector<Cells> lines{head};
  for (const PointSummary& point : points) {
    const Quartiles& time = point.milliseconds;
    const std::optional<KeptBounds>& bounds = point.check.bounds;
    Cells cells{fmt::format("{}", point.point.lights)};
    cells.insert(cells.end(), point.point.values.begin(), point.point.values.end());
    cells.push_back(point.runs > 0 ? fmt::format("{:.1f}", time.median) : kNoFigure);
    // One run has none.
    cells.push_back(
        point.is_own || point.runs > 1
            ? fmt::format("± {:.0f} %", time.median > 0 ? 50 * (time.high - time.low) / time.median : 0.0)
            : kNoFigure);
    const ImageDifference& error = point.check.error;
    for (const double figure : {error.mean_abs, error.max_abs, error.relmse, error.smape})
      cells.push_back(errorText(figure));
    cells.push_back(point.is_own ? fmt::format("{:.0f}", double(point.peak_bytes) / (1 << 20)) : kNoFigure);
    cells.push_back(point.front ? "*" : "");
    if (have_ratios) cells.push_back(ratioText(point));
    if (are_bounded) {
      cells.push_back(bounds ? fmt::format("{:.1e}", bounds->max_bound) : kNoFigure);
      cells.push_back(bounds ? fmt::format("{:.1e}", bounds->mean_bound) : kNoFigure);
      cells.push_back(bounds ? fmt::format("{:.2f}", bounds->max_used) : kNoFigure);
      cells.push_back(bounds ? fmt::format("{:.2f}", bounds->mean_used) : kNoFigure);
    }
    if (are_sampled) cells.push_back(bounds ? fmt::format("{:.2f}", 100 * bounds->held) : kNoFigure);
    if (truths_differ) cells.push_back(point.truth);
    lines.push_back(cells);
  }
  return textTable(lines);
}

std::string exponentText(const GrowthFit& fit) {
  return fmt::format("{:.2f} ({:.2f} to {:.2f})", fit.c, fit.c_low, fit.c_high);
}

/// The milliseconds of a fit that depend on the number of lights, without the constant.
double grownTime(const GrowthFit& fit, double lights) { return fit.b * std::pow(lights, fit.c); }

/// The variant's stages whose growth comes to at least kLeastShare of its time, the largest first.
std::string growingStages(const ScaleSummary& summary, const Cells& values) {
  const double lights = double(summary.points.back().point.lights);
  double whole = 0;
  for (const PointSummary& point : summary.points)
    if (point.point.values == values) whole = point.milliseconds.median;
  std::vector<const StageGrowth*> stages;
  for (const StageGrowth& row : summary.growth)
    if (row.values == values && row.stage != kWhole && row.growth.fit &&
        grownTime(*row.growth.fit, lights) >= kLeastShare * whole)
      stages.push_back(&row);
  std::stable_sort(stages.begin(), stages.end(), [&](const StageGrowth* a, const StageGrowth* b) {
    return grownTime(*a->growth.fit, lights) > grownTime(*b->growth.fit, lights);
  });
  std::string text;
  for (std::size_t i = 0; i < std::min(stages.size(), kMostStages); ++i)
    text += fmt::format("{}{} {}", i ? ", " : "", stages[i]->stage, exponentText(*stages[i]->growth.fit));
  return text;
}

std::string growthTable(const ScaleSummary& summary) {
  std::vector<Cells> lines{axisNames(summary.description)};
  for (const char* name : {"c of the whole (95 %)", "c of the stages that grow"}) lines[0].push_back(name);
  for (const StageGrowth& row : summary.growth) {
    if (row.stage != kWhole) continue;
    Cells cells = row.values;
    cells.push_back(row.growth.fit ? exponentText(*row.growth.fit) : row.growth.reason);
    cells.push_back(growingStages(summary, row.values));
    lines.push_back(cells);
  }
  return textTable(lines);
}

}  // namespace

std::string scaleTable(const ScaleSummary& summary) {
  if (summary.points.empty()) return "";
  std::vector<PointSummary> points = summary.points;
  const std::uint64_t most = points.back().point.lights;
  const bool is_cut = points.size() > kMostRows;
  if (is_cut) std::erase_if(points, [&](const PointSummary& point) { return point.point.lights != most; });
  std::string text = pointTable(summary, points);
  if (is_cut)
    text += fmt::format("The {} points of fewer lights are in results.csv.\n",
                        summary.points.size() - points.size());
  if (std::any_of(points.begin(), points.end(),
                  [](const PointSummary& point) { return point.check.bounds.has_value(); }))
    text +=
        "Bounds are shares of the larger of 1 and the colour. –: there are lights that are summed one by "
        "one.\n";
  if (std::any_of(points.begin(), points.end(), isSampled))
    text +=
        "Of lights that cast shadows a bound is half an interval, within which a pixel is with the stated "
        "confidence.\n";
  return text + "\nGrowth: ms = a + b * lights^c. All stages, with a and b, are in growth.json.\n\n" +
         growthTable(summary);
}

}  // namespace luciole
