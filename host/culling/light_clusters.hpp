#pragma once

#include <span>

#include "culling/shade_lights.hpp"

namespace luciole {

/// The tree over the lights that clusters of it may stand for. Interim: the lights themselves.
struct LightClusters {
  LightArray lights;
};

/// lights: view space; point lights without a range, with attenuation (0, 0, q).
LightClusters buildLightClusters(std::span<const ShadeLight> lights);

}  // namespace luciole
