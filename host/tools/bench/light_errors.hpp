#pragma once

#include "tools/bench/speed_input.hpp"
#include "tools/bench/speed_table.hpp"

namespace luciole {

inline constexpr const char* kLightErrors = "light error";

/// Measures what a bound on the error of lights without range costs (ShadeSettings::light_error), and how it
/// is kept: 10³, 10⁴ … input.most_lights lights in a box, in clusters and on surfaces, of the scene given or
/// the hall of speed_scenes.hpp with matte surfaces. The bounds are held against all lights in double
/// precision at about a thousand pixels. A broken one is a failure of the table. Throws InputError if the
/// camera sees nothing, and MachineError.
SpeedTable measureLightErrors(const SpeedInput& input);

}  // namespace luciole
