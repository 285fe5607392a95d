#pragma once

#include "bench/speed_input.hpp"
#include "bench/speed_table.hpp"

namespace luciole {

/// What culling and shading cost where lights are many and near: the hall of speed_scenes.hpp.
SpeedTable measureCulledShading(const SpeedInput& input);

}  // namespace luciole
