#pragma once

#include <string>
#include <vector>

#include "figures/growth.hpp"
#include "figures/statistics.hpp"
#include "scale/scale_log.hpp"

namespace luciole {

struct StageSummary {
  std::string name;
  Quartiles milliseconds;
};

/// A point that was checked and timed once or more.
struct PointSummary {
  ScalePoint point;
  int runs = 0;
  Quartiles milliseconds;            ///< of all stages together
  std::vector<StageSummary> stages;  ///< in the order in which they ran
  PointCheck check;
  std::uint64_t device_bytes = 0, peak_bytes = 0;  ///< the most of any run
  std::string truth;  ///< what `check` holds it against, see truthName(): errors compare where it is equal
  /// Of those with this truth and as many lights none is both faster and nearer to it.
  bool front = false;
};

/// The name of all stages together.
inline constexpr const char* kWhole = "total";

/// How a stage's time grows with the lights, other things being equal.
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
  std::size_t incomplete = 0;  ///< points that lack their check or one of their runs
};

/// The axes' values in one line, for people: "culling tiles, tile 4"; empty where there are no axes.
std::string variantName(const ScaleDescription& description, const std::vector<std::string>& values);

/// What a log's results come to.
ScaleSummary summarizeScale(const ScaleResults& results);

}  // namespace luciole
