#pragma once

#include <cstdint>

#include "cl/device.hpp"
#include "lighting/stats.hpp"
#include "luciole/render.hpp"

namespace luciole {

/// bakeLight() of a scene without fog and background. Adds to the statistics.
Image bakeMap(OpenedDevice& device, const Scene& scene, std::uint32_t object, const BakeSettings& bake,
              RenderSettings settings, Stats& stats);

}  // namespace luciole
