#pragma once

#include "scale/scale_log.hpp"

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
          .mean_abs = error,
          .max_abs = 2 * error,
          .rmse = 1.5 * error,
          .picture = "pictures/" + name + ".png",
          .error_map = "pictures/" + name + "-error.png",
          .list_map = "pictures/" + name + "-lists.png"};
}

inline PointRun madeUpRun(double cull, double shade) {
  return {.stages = {{"cull", cull}, {"shade", shade}}, .device_bytes = 1000, .peak_bytes = 2000};
}

}  // namespace luciole::test
