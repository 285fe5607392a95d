#pragma once

#include "tools/bench/speed_input.hpp"
#include "tools/bench/speed_table.hpp"

namespace luciole {

inline constexpr const char* kLightErrors = "light error";

/// Measures the time and the actual errors of ShadeSettings::light_error for lights without range: 10³, 10⁴ …
/// input.most_lights lights in a box, in clusters and on surfaces, of the scene given or the hall of
/// speed_scenes.hpp with matte surfaces. The bounds are held against all lights in double precision at about
/// a thousand pixels. A broken one is a failure of the table. Throws InputError if the camera sees nothing,
/// and MachineError.
SpeedTable measureLightErrors(const SpeedInput& input);

}  // namespace luciole
