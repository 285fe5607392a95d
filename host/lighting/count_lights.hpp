#pragma once

#include "lighting/stages.hpp"

namespace luciole {

/// Fills in the counts that are asked for, of what the points were shaded with. in_range: memory for lists.
/// Throws MachineError.
void countLights(const StageInput& input, const PixelCounts& counts, LightLists& in_range, LitPlanes& lit);

}  // namespace luciole
