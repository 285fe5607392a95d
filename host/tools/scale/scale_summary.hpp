#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/figures/growth.hpp"
#include "tools/figures/statistics.hpp"
#include "tools/scale/scale_log.hpp"

namespace luciole {

struct StageSummary {
  std::string name;
  Quartiles milliseconds;
};

/// A point that has its check and at least one timed run, or is of a method without times.
struct PointSummary {
  ScalePoint point;
  bool is_own = true;  ///< Luciole's, rather than another method's
  int runs = 0;
  Quartiles milliseconds;  ///< of all stages together; NaN without runs
  /// How many times as long as the experiment's first variant by as many lights, round by round. Of a method
  /// with a single time all rounds have that.
  std::optional<TimeRatio> times_first;
  std::vector<StageSummary> stages;  ///< in the order in which they ran; none of another method
  PointCheck check;
  std::uint64_t device_bytes = 0, peak_bytes = 0;  ///< the most of any run
  std::string truth;  ///< see truthName(): errors of points can be compared if it is equal
  /// On the Pareto front (see paretoFront) of the points with this truth and the same number of lights.
  bool front = false;
  /// The figures of kImageMetrics by which it is on such a front, in place of the mean error.
  std::vector<std::string> fronts;
};

/// The name of all stages together.
inline constexpr const char* kWhole = "total";

/// How a stage's time grows with the number of lights for one variant.
struct StageGrowth {
  std::vector<std::string> values;  ///< of the axes
  std::string stage;                ///< or kWhole
  Growth growth;
};

struct ScaleSummary {
  ScaleDescription description;
  std::vector<Machine> machines;
  std::vector<PointSummary> points;  ///< in the order of the description
  std::vector<StageGrowth> growth;
  std::vector<std::string> incomplete;  ///< names of points that lack their check or one of their runs
  /// Points whose picture breaks what its bounds promise (see brokenPromise()), a line each, for people: a
  /// fault of the program.
  std::vector<std::string> violations;
};

/// The axes' values in one line, for people: "culling tiles, tile 4"; empty if there are no axes. Beside
/// other methods, which are called by their names alone, Luciole is named where nothing else is.
std::string variantName(const ScaleDescription& description, const std::vector<std::string>& values);

/// Summarizes a log's results: quartiles of times, Pareto fronts and growth.
ScaleSummary summarizeScale(const ScaleResults& results);

}  // namespace luciole
