#pragma once

#include <string>

#include "scale/scale_summary.hpp"

namespace luciole {

/// Time against lights as an SVG picture, on logarithmic axes with quartiles as bars: the variant that is
/// fastest with the most lights by stage, and beside it, where there are others, all variants as wholes.
/// Stages that never take a hundredth of the time are left out. There is one point at least.
std::string scalePlot(const ScaleSummary& summary);

}  // namespace luciole
