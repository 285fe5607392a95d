#pragma once

#include "bench/speed_input.hpp"
#include "bench/speed_table.hpp"

namespace luciole {

/// By how much the memory of luciole render grows with a pixel and with a light.
SpeedTable measureMemory(const SpeedInput& input);

}  // namespace luciole
