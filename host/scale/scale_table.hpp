#pragma once

#include <string>

#include "scale/scale_summary.hpp"

namespace luciole {

/// What an experiment comes to, to read on a terminal: time, error and memory against lights, then how each
/// variant's time grows as a whole and in the stages that matter.
std::string scaleTable(const ScaleSummary& summary);

}  // namespace luciole
