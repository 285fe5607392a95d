#include "tools/scale/scale_summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

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

PointSummary summarizePoint(const ScaleDescription& description, const ScalePoint& point,
                            const PointRecord& record) {
  PointSummary summary;
  summary.point = point;
  summary.truth = truthName(description, point);
  summary.runs = int(record.runs.size());
  summary.check = *record.check;
  std::vector<double> totals;
  for (const auto& [repeat, run] : record.runs) {
    double total = 0;
    for (const auto& [name, milliseconds] : run.stages) total += milliseconds;
    totals.push_back(total);
    summary.device_bytes = std::max(summary.device_bytes, run.device_bytes);
    summary.peak_bytes = std::max(summary.peak_bytes, run.peak_bytes);
  }
  summary.milliseconds = quartiles(totals);
  for (const std::string& name : stageNames(record)) {
    std::vector<double> times;
    for (const auto& [repeat, run] : record.runs) times.push_back(timeOf(run, name));
    summary.stages.push_back({name, quartiles(times)});
  }
  return summary;
}

void markFronts(std::vector<PointSummary>& points) {
  std::map<std::pair<std::uint64_t, std::string>, std::vector<PointSummary*>> of_picture;
  for (PointSummary& point : points) of_picture[{point.point.lights, point.truth}].push_back(&point);
  for (const auto& [picture, rivals] : of_picture) {
    std::vector<SpeedAndError> figures;
    for (const PointSummary* rival : rivals) {
      const Quartiles& time = rival->milliseconds;
      figures.push_back({{time.median, (time.high - time.low) / 2}, rival->check.error.mean_abs});
    }
    const std::vector<bool> front = paretoFront(figures);
    for (std::size_t i = 0; i < rivals.size(); ++i) rivals[i]->front = front[i];
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
  std::string name;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (values[i] == kNotThis) continue;
    name += fmt::format("{}{} {}", name.empty() ? "" : ", ", description.axes[i].name, values[i]);
  }
  return name;
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
    if (!is_checked || int(found->second.runs.size()) < results.description.repeats)
      summary.incomplete.push_back(name);
    if (is_checked && !found->second.runs.empty())
      summary.points.push_back(summarizePoint(results.description, point, found->second));
  }
  markFronts(summary.points);
  summary.growth = fitAll(summary.points);
  return summary;
}

}  // namespace luciole
