#pragma once

#include "tools/bench/speed_input.hpp"
#include "tools/bench/speed_table.hpp"

namespace luciole {

inline constexpr const char* kShadowedLights = "shadowed lights";

/// Measures the time and the true errors of ways to light a picture by 10³, 10⁴ … 10⁵ lights without range
/// (or input.most_lights) that all cast exact shadows: one by one, every ray by Embree, sampled by
/// ShadeSettings::light_error, and sampled plainly by a tree of lights for as long. The scene given, or two
/// of those that come with the program. Errors are from every light in double precision by Embree's rays.
/// Where an interval holds less often than stated, the table has a failure. Throws InputError if the camera
/// sees nothing, and MachineError.
SpeedTable measureShadowedLights(const SpeedInput& input);

}  // namespace luciole
