#pragma once

#include "tools/bench/speed_input.hpp"
#include "tools/bench/speed_table.hpp"

namespace luciole {

/// Measures by how many bytes the memory of luciole render grows with a pixel and with a light. Throws
/// MachineError.
SpeedTable measureMemory(const SpeedInput& input);

}  // namespace luciole
