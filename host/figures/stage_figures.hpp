#pragma once

#include <string_view>

#include "render/stats.hpp"

namespace luciole {

/// Milliseconds of a stage; 0 for one that did not run.
double stageTime(const Stats& stats, Stage stage);

/// A count of the statistics; 0 for one that isn't there.
double countOf(const Stats& stats, std::string_view name);

}  // namespace luciole
