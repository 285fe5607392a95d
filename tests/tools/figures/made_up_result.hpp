#pragma once

#include "tools/bench/bench.hpp"

namespace luciole::test {

inline BenchRow madeUpRow(const std::string& name, double milliseconds, double mean_error, bool front,
                          bool is_default = false) {
  BenchRow row;
  row.variant.name = name;
  row.variant.lanes = 8;
  row.variant.is_default = is_default;
  row.time = {milliseconds, milliseconds / 20};
  row.error.max_abs = 4 * mean_error;
  row.error.mean_abs = mean_error;
  row.error.mean_signed = -mean_error / 2;
  row.error.relmse = 2 * mean_error * mean_error;
  row.error.smape = 3 * mean_error;
  row.brightest = 2;
  row.front = front;
  return row;
}

/// Two groups of few rows whose figures are round in 8-bit steps, and a table of speed.
inline BenchResult madeUpResult() {
  BenchResult result;
  result.machine.processor = "A processor";
  result.machine.threads = 2;
  result.machine.device.platform = "A platform";
  result.machine.device.version = "1.2";
  result.machine.device.lanes = 8;
  result.scene = "it's a scene.json";
  result.triangles = 12;
  result.lights = 3;
  result.width = 64;
  result.height = 36;
  result.repeats = 5;
  BenchGroup shading{.group = {.name = "shading", .measured = "culling and shading"}};
  shading.rows = {madeUpRow("usual", 10, 1e-3 / 255, true, true), madeUpRow("rough", 8, 0.5 / 255, true),
                  madeUpRow("slow", 40, 1e-3 / 255, false)};
  BenchGroup samples{.group = {.name = "samples", .measured = "the whole picture", .samples = true},
                     .truth_error = 0.01 / 255};
  samples.rows = {madeUpRow("samples 1", 20, 0.4 / 255, true, true),
                  madeUpRow("samples 2", 40, 0.2 / 255, true)};
  result.groups = {shading, samples};
  result.speed = {{.name = "a stage",
                   .measured = "what it costs",
                   .columns = {{"milliseconds", "ms", 2}, {"entries", "entries", 0}},
                   .rows = {{"one", {Repeated{12.345, 1.2345}, 7.0}},
                            {"two", {Repeated{0, 0}, NoValue{"nobody counted"}}}}}};
  return result;
}

}  // namespace luciole::test
