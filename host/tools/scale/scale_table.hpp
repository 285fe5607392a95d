#pragma once

#include <string>

#include "tools/scale/scale_summary.hpp"

namespace luciole {

/// An experiment's results as tables for a terminal: time, error and memory over the number of lights, then
/// how each variant's total time, and that of the stages that matter, grows.
std::string scaleTable(const ScaleSummary& summary);

}  // namespace luciole
