#pragma once

#include <string>

#include "tools/scale/scale_summary.hpp"

namespace luciole {

/// The content of results.csv. A line for each point: lights, the axes' values, times of the whole and of
/// each stage with quartiles (milliseconds), pairs, memory, errors.
std::string scaleCsv(const ScaleSummary& summary);

/// The content of growth.json: the machines, and for each stage of each variant a, b and c (see GrowthFit)
/// with c's confidence interval, or the reason why there is no fit.
std::string growthJson(const ScaleSummary& summary);

/// The data of the page (see page.js) as JSON, with the pictures in `folder`, up to 64 MiB of them.
/// command: the command line of the experiment. Throws InputError for a picture that isn't a file in the
/// folder.
std::string pageData(const ScaleSummary& summary, const std::string& folder, const std::string& command);

}  // namespace luciole
