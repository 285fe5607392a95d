#pragma once

#include <string>

#include "scale/scale_summary.hpp"

namespace luciole {

/// One line a point: lights, the axes' values, time as a whole and by stage with quartiles (milliseconds),
/// pairs, memory, errors.
std::string scaleCsv(const ScaleSummary& summary);

/// The machines, and a, b and c of each stage of each variant with c's confidence interval, or why there are
/// none, as JSON.
std::string growthJson(const ScaleSummary& summary);

/// What the page shows (see page.js), as JSON, with the pictures in `folder` inside it. `command`: how the
/// experiment was asked for.
std::string pageData(const ScaleSummary& summary, const std::string& folder, const std::string& command);

}  // namespace luciole
