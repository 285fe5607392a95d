#pragma once

#include "bench/speed_input.hpp"
#include "bench/speed_table.hpp"

namespace luciole {

/// What the rasterizer costs by one thread and by all: the named scene, or the hall of speed_scenes.hpp, as a
/// G-buffer with every group and as a depth map.
SpeedTable measureRasterizer(const SpeedInput& input);

}  // namespace luciole
