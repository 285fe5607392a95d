#pragma once

#include "tools/bench/speed_input.hpp"
#include "tools/bench/speed_table.hpp"

namespace luciole {

/// Measures the wall-clock time of the whole process for a picture of 64 x 64 pixels: with an empty kernel
/// cache of its own, and with the cache that such a run has filled. Throws MachineError.
SpeedTable measureStart(const SpeedInput& input);

}  // namespace luciole
