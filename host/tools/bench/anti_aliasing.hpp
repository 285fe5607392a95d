#pragma once

#include "tools/bench/speed_input.hpp"
#include "tools/bench/speed_table.hpp"

namespace luciole {

/// Measures whole pictures of 4, 16 and 64 samples a pixel, with every sample shaded and with those shaded
/// once that see the same surface, against one of 256 samples that are all shaded. Of the scene given or the
/// built-in one, with soft edges of shadows (pcf). Throws MachineError.
SpeedTable measureAntiAliasing(const SpeedInput& input);

}  // namespace luciole
