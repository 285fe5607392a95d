#pragma once

#include "tools/bench/speed_input.hpp"
#include "tools/bench/speed_table.hpp"

namespace luciole {

/// Measures culling and shading by many near lights: the hall of speed_scenes.hpp. Throws MachineError.
SpeedTable measureCulledShading(const SpeedInput& input);

}  // namespace luciole
