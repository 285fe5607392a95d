#pragma once

#include "bench/speed_input.hpp"
#include "bench/speed_table.hpp"

namespace luciole {

/// Wall time of the whole process for a picture of 64 x 64 pixels: with an empty kernel cache of its own, and
/// with the one that this left behind.
SpeedTable measureStart(const SpeedInput& input);

}  // namespace luciole
