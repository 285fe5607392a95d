#pragma once

#include "tools/bench/speed_input.hpp"
#include "tools/bench/speed_table.hpp"

namespace luciole {

/// Measures the rasterizer with one thread and with all: the named scene, or the hall of speed_scenes.hpp, as
/// a G-buffer with all groups and as a depth map.
SpeedTable measureRasterizer(const SpeedInput& input);

}  // namespace luciole
