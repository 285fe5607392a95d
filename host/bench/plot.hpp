#pragma once

#include <string>

#include "bench/bench.hpp"

namespace luciole {

/// The result as an SVG picture: a panel a group that has one truth, error over time on logarithmic axes, the
/// front as a line.
std::string benchPlot(const BenchResult& result);

}  // namespace luciole
