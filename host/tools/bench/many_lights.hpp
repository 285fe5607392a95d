#pragma once

#include "tools/bench/speed_input.hpp"
#include "tools/bench/speed_table.hpp"

namespace luciole {

/// Measures how culling and shading grow with the number of lights, up to input.most_lights: a sphere of
/// lights around the camera, and a city with 1, 10, 100 … lights that fill it evenly. Throws MachineError.
SpeedTable measureManyLights(const SpeedInput& input);

}  // namespace luciole
