#pragma once

#include <string>
#include <vector>

#include "experiment/bench.hpp"

namespace luciole {

/// The result as an SVG picture: a panel a group that has one truth, error over time on logarithmic axes, the
/// front as a line. Throws as runGnuplot does.
std::string benchPlot(const BenchResult& result);

/// Round numbers in [low, high], 0 < low < high, for a logarithmic axis: powers of ten where the range holds
/// three of them or more, else as many of their multiples as it takes to have three.
std::vector<double> logTicks(double low, double high);

}  // namespace luciole
