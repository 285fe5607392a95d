#pragma once

#include "shade/features.hpp"
#include "tools/bench/shadow_truth.hpp"
#include "tools/bench/speed_input.hpp"
#include "tools/bench/speed_table.hpp"

namespace luciole {

/// Compares shadows with rays. For every method and size of maps: the times of preparation and of the
/// shadows, the number of wrong pairs of a pixel and a light, and Embree's time for the same pairs. Measures
/// the scene given, with one sample and with several, alone and as frames of a moving camera, or
/// makeShadowScenes() and some halls (makeLampHall) if there is none. Throws MachineError.
SpeedTable measureShadowErrors(const SpeedInput& input);

/// How many pairs of a pixel and a light these settings' shadows get wrong, in the picture of `size` pixels
/// that the scene's first camera sees. Throws MachineError.
ShadowErrors shadowErrors(OpenedDevice& device, const Scene& scene, glm::ivec2 size,
                          const ShadeSettings& settings);

}  // namespace luciole
