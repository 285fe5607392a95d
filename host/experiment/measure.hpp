#pragma once

#include <functional>
#include <string>
#include <vector>

#include "cl/device.hpp"
#include "experiment/statistics.hpp"
#include "experiment/variants.hpp"
#include "image/compare.hpp"
#include "render/render.hpp"

namespace luciole {

struct BenchSettings {
  RenderSettings picture;  ///< size and camera; the variants replace `shade` and `samples`
  std::string device;      ///< selector
  int repeats = 9;
  /// Called now and then, if set.
  std::function<void(const std::string& what, std::size_t done, std::size_t total)> on_progress;
};

struct BenchRow {
  Variant variant;
  Timing time{};            ///< milliseconds
  ImageDifference error{};  ///< from the truth, linear units
  bool front = false;
};

struct BenchGroup {
  VariantGroup group;
  double brightest = 0;  ///< the truth's largest value: what relative errors are relative to
  /// Mean absolute error that the truth itself may have; 0: only what float rounds off, 2⁻²⁴ of each value.
  double truth_error = 0;
  std::vector<BenchRow> rows{};  ///< in the order of group.variants
};

struct Machine {
  std::string processor;
  unsigned threads = 0;
  DeviceDescription device;
  std::string compiler;
};

struct BenchResult {
  Machine machine;
  std::string scene;
  std::uint64_t triangles = 0, lights = 0;
  int width = 0, height = 0, repeats = 0;
  std::vector<BenchGroup> groups{};
};

/// Makes every variant's picture, holds it against its group's truth, and times it. Each group runs in
/// rounds, every variant once a round and each round beginning with another one, so that what else the
/// machine does falls on all alike. Loading and compiling are left out. Throws InputError, MachineError.
BenchResult runBench(const Scene& scene, const BenchSettings& settings);

}  // namespace luciole
