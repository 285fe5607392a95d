#pragma once

#include "tools/scale/scale_log.hpp"

namespace luciole::test {

/// Two numbers of lights, two ways: four points, two runs each.
inline ScaleDescription madeUpExperiment() {
  ScaleDescription description;
  description.version = "1";
  description.scene = "halls/a, b.json";
  description.digest = 0xfedcba9876543210u;
  description.settings = {{"size", "8x4"}, {"seed", "7"}};
  description.lights = {1, 100};
  description.axes = {{"culling", {"none", "tiles"}}};
  for (const std::uint64_t lights : description.lights)
    for (const std::string& value : description.axes[0].values)
      description.points.push_back({lights, {value}});
  description.repeats = 2;
  return description;
}

inline Machine madeUpMachine(const std::string& processor) {
  return {processor, 2, std::uint64_t(1) << 34, "Linux 6", {"Portable", "cpu-x", "3.1", 16}, "12.2"};
}

inline PointCheck madeUpCheck(const std::string& name, double error) {
  return {.pairs_evaluated = 320,
          .pairs_in_range = 100,
          .pixels_lit = 32,
          .list_entries = 40,
          .reach = 1.5,
          .pixels = 16,
          .error = {.max_abs = 2 * error,
                    .mean_abs = error,
                    .rmse = 1.5 * error,
                    .relmse = 3 * error,
                    .smape = 4 * error},
          .picture = "pictures/" + name + ".png",
          .error_map = "pictures/" + name + "-error.png",
          .list_map = "pictures/" + name + "-lists.png"};
}

/// Of an error that is a share of its bound.
inline KeptBounds madeUpBounds(double bound, double used) {
  return {.max_bound = bound,
          .mean_bound = bound / 2,
          .max_error = used * bound,
          .mean_error = used * bound / 8,
          .max_used = used,
          .mean_used = used / 4,
          .values = 48};
}

/// Light errors of 1/4 and 1/16 in two places, by 1 and 100 lights; the one of 1 light is exact.
inline ScaleResults madeUpLightErrors() {
  ScaleResults results{madeUpExperiment(), {}, {}};
  ScaleDescription& description = results.description;
  description.axes = {{"field", {"box", "ball"}}, {kLightErrorAxis, {"1/4", "1/16"}}};
  description.points.clear();
  for (const std::uint64_t lights : description.lights)
    for (const std::string& field : description.axes[0].values)
      for (const std::string& error : description.axes[1].values) {
        description.points.push_back({lights, {field, error}});
        PointRecord& record = results.records[pointName(description, description.points.back())];
        const double bound = error == "1/4" ? 0.25 : 0.0625;
        record.check = madeUpCheck(std::to_string(results.records.size()), 0.25 * bound);
        if (lights > 1) record.check->bounds = madeUpBounds(bound, 0.5);
        if (lights > 1) record.check->bound_map = "pictures/bounds.png";
        record.runs[0] = record.runs[1] = PointRun{.stages = {{"shade", 1 / bound}}};
      }
  return results;
}

inline PointRun madeUpRun(double cull, double shade) {
  return {.stages = {{"cull", cull}, {"shade", shade}}, .device_bytes = 1000, .peak_bytes = 2000};
}

}  // namespace luciole::test
