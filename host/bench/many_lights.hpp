#pragma once

#include "bench/speed_input.hpp"
#include "bench/speed_table.hpp"

namespace luciole {

/// What culling and shading cost as lights become more, up to input.most_lights: a sphere of lights around
/// the camera, and a city with 1, 10, 100 … lights that fill it evenly.
SpeedTable measureManyLights(const SpeedInput& input);

}  // namespace luciole
