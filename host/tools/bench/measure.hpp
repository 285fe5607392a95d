#pragma once

#include <string>
#include <vector>

#include "cl/device.hpp"
#include "luciole/compare.hpp"
#include "render/render.hpp"
#include "tools/bench/variants.hpp"
#include "tools/figures/rounds.hpp"

namespace luciole {

struct BenchSettings {
  RenderSettings picture;  ///< size and camera of the scene; the variants replace `shade` and `samples`
  std::string device;      ///< selector
  int repeats = 9;
  OnProgress on_progress{};
};

struct BenchRow {
  Variant variant;
  Repeated time{};          ///< milliseconds
  ImageDifference error{};  ///< from the truth, linear units
  double brightest =
      0;               ///< the reference's largest value, by which relative errors are divided unless it is 0
  bool front = false;  ///< on the Pareto front, in a group that has one truth
};

struct BenchGroup {
  VariantGroup group;
  /// Estimate of the truth's own mean absolute error; 0: only float's rounding, 2⁻²⁴ of each value.
  double truth_error = 0;
  std::vector<BenchRow> rows{};  ///< in the order of group.variants
};

/// Makes every variant's picture, compares it with its group's truth, and times it, in rounds. Times don't
/// contain loading and compiling. Throws InputError for a device that isn't there, and MachineError.
std::vector<BenchGroup> measureVariants(const Scene& scene, const std::vector<VariantGroup>& groups,
                                        const BenchSettings& settings);

}  // namespace luciole
