#include "tools/scale/scale_summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "tools/scale/scale_method.hpp"
#include "tools/scale/scale_truth.hpp"

namespace luciole {
namespace {

/// The names of the stages of all runs, each at its place in the first run that had it.
std::vector<std::string> stageNames(const PointRecord& record) {
  std::vector<std::string> names;
  for (const auto& [repeat, run] : record.runs)
    for (const auto& [name, milliseconds] : run.stages)
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  return names;
}

double timeOf(const PointRun& run, const std::string& stage) {
  for (const auto& [name, milliseconds] : run.stages)
    if (name == stage) return milliseconds;
  return 0;
}

double totalOf(const PointRun& run) {
  double total = 0;
  for (const auto& [name, milliseconds] : run.stages) total += milliseconds;
  return total;
}

/// The ratio of the rounds that both have. The one run of a method with a single time is of each.
std::optional<TimeRatio> ratioOf(const PointRecord& record, const PointRecord& first, bool has_one_time) {
  std::vector<double> over, under;
  for (const auto& [repeat, run] : first.runs) {
    const auto same = record.runs.find(has_one_time ? 0 : repeat);
    if (same == record.runs.end()) continue;
    over.push_back(totalOf(same->second));
    under.push_back(totalOf(run));
  }
  return timeRatio(over, under);
}

PointSummary summarizePoint(const ScaleDescription& description, const ScalePoint& point,
                            const PointRecord& record) {
  PointSummary summary;
  summary.point = point;
  summary.is_own = methodOf(description, point) == nullptr;
  summary.truth = truthName(description, point);
  summary.runs = int(record.runs.size());
  summary.check = *record.check;
  std::vector<double> totals;
  for (const auto& [repeat, run] : record.runs) {
    totals.push_back(totalOf(run));
    summary.device_bytes = std::max(summary.device_bytes, run.device_bytes);
    summary.peak_bytes = std::max(summary.peak_bytes, run.peak_bytes);
  }
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  summary.milliseconds = totals.empty() ? Quartiles{kUnknown, kUnknown, kUnknown} : quartiles(totals);
  if (!summary.is_own) return summary;
  for (const std::string& name : stageNames(record)) {
    std::vector<double> times;
    for (const auto& [repeat, run] : record.runs) times.push_back(timeOf(run, name));
    summary.stages.push_back({name, quartiles(times)});
  }
  return summary;
}

void markFronts(std::vector<PointSummary>& points) {
  std::map<std::pair<std::uint64_t, std::string>, std::vector<PointSummary*>> of_picture;
  for (PointSummary& point : points)
    if (point.runs > 0) of_picture[{point.point.lights, point.truth}].push_back(&point);
  for (const auto& [picture, rivals] : of_picture) {
    for (const auto& [name, figure] : kImageMetrics) {
      std::vector<SpeedAndError> figures;
      for (const PointSummary* rival : rivals) {
        const Quartiles& time = rival->milliseconds;
        figures.push_back({{time.median, (time.high - time.low) / 2}, std::abs(rival->check.error.*figure)});
      }
      const std::vector<bool> front = paretoFront(figures);
      for (std::size_t i = 0; i < rivals.size(); ++i) {
        if (!front[i] || figure == &ImageDifference::psnr) continue;  // mse is the same, and less is better
        rivals[i]->fronts.emplace_back(name);
        rivals[i]->front |= figure == &ImageDifference::mean_abs;
      }
    }
  }
}

/// Times over numbers of lights. Times of 0 are left out, because the fit is of relative residuals.
struct Curve {
  std::vector<double> lights, milliseconds;

  void add(std::uint64_t count, double time) {
    if (!(time > 0)) return;
    lights.push_back(double(count));
    milliseconds.push_back(time);
  }
};

std::vector<StageGrowth> fitAll(const std::vector<PointSummary>& points) {
  std::vector<StageGrowth> fits;
  std::vector<std::vector<std::string>> variants;
  for (const PointSummary& point : points)
    if (std::find(variants.begin(), variants.end(), point.point.values) == variants.end())
      variants.push_back(point.point.values);
  for (const auto& values : variants) {
    std::vector<std::string> names{kWhole};
    std::map<std::string, Curve> curves;
    for (const PointSummary& point : points) {
      if (point.point.values != values) continue;
      curves[kWhole].add(point.point.lights, point.milliseconds.median);
      for (const StageSummary& stage : point.stages) {
        if (std::find(names.begin(), names.end(), stage.name) == names.end()) names.push_back(stage.name);
        curves[stage.name].add(point.point.lights, stage.milliseconds.median);
      }
    }
    for (const std::string& name : names)
      if (const Curve& curve = curves[name]; !curve.lights.empty())
        fits.push_back({values, name, fitGrowth(curve.lights, curve.milliseconds)});
  }
  return fits;
}

}  // namespace

std::string variantName(const ScaleDescription& description, const std::vector<std::string>& values) {
  std::string name, maker;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (description.axes[i].name == kMethodAxis)
      maker = values[i];
    else if (values[i] != kNotThis)
      name += fmt::format("{}{} {}", name.empty() ? "" : ", ", description.axes[i].name, values[i]);
  }
  return name.empty() ? maker : name;
}

ScaleSummary summarizeScale(const ScaleResults& results) {
  ScaleSummary summary;
  summary.description = results.description;
  summary.machines = results.machines;
  for (const ScalePoint& point : results.description.points) {
    const std::string name = pointName(results.description, point);
    const auto found = results.records.find(name);
    const bool is_checked = found != results.records.end() && found->second.check;
    if (is_checked && found->second.check->bounds)
      if (const std::string broken = brokenPromise(*found->second.check->bounds); !broken.empty())
        summary.violations.push_back(found->first + ": " + broken);
    const int runs = runsOf(results.description, point);
    if (!is_checked || int(found->second.runs.size()) < runs) summary.incomplete.push_back(name);
    if (!is_checked || (found->second.runs.empty() && runs > 0)) continue;
    summary.points.push_back(summarizePoint(results.description, point, found->second));
    const auto first = results.records.find(
        pointName(results.description, {point.lights, results.description.points.front().values}));
    if (first != results.records.end() && first != found)
      summary.points.back().times_first = ratioOf(found->second, first->second, runs == 1);
  }
  markFronts(summary.points);
  summary.growth = fitAll(summary.points);
  return summary;
}

}  // namespace luciole
