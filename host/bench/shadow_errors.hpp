#pragma once

#include "bench/shadow_truth.hpp"
#include "bench/speed_input.hpp"
#include "bench/speed_table.hpp"
#include "render/features.hpp"

namespace luciole {

/// Shadow maps against rays: for every method and size what drawing and looking up cost and which pairs of a
/// pixel and a light they get wrong, and what Embree takes for the same pairs. Of the scene given, or of five
/// that are hard for shadow maps.
SpeedTable measureShadowErrors(const SpeedInput& input);

/// What shadows drawn and looked up like this get wrong where the scene's first camera looks.
ShadowErrors shadowErrors(Device& device, const Scene& scene, glm::ivec2 size, const ShadeSettings& settings);

}  // namespace luciole
