#pragma once

#include <string>

#include "tools/scale/scale_summary.hpp"

namespace luciole {

/// Time over number of lights as an SVG picture, on logarithmic axes, with quartiles as bars. One panel shows
/// the stages of the variant that is fastest with the most lights, without those that never take 1 % of its
/// time. If there are other variants, a second panel shows the total time of all. There must be at least one
/// point of Luciole's own.
std::string scalePlot(const ScaleSummary& summary);

}  // namespace luciole
