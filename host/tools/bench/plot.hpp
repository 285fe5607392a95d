#pragma once

#include <string>

#include "tools/bench/bench.hpp"

namespace luciole {

/// The result as an SVG picture: for each group with one truth a panel that shows error over time on
/// logarithmic axes, with the Pareto front as a line; and the bounds and errors of light error, if measured.
std::string benchPlot(const BenchResult& result);

}  // namespace luciole
