#pragma once

#include <vector>

#include "base/array_memory.hpp"
#include "kernels/shared.h"
#include "scene/scene.hpp"
#include "shadow/shadow_maps.hpp"

namespace luciole {

using LightArray = std::vector<ShadeLight, ArrayAllocator<ShadeLight>>;

/// Brings the lights into the camera's view space, in the order of spatialOrder. shadow_maps: empty where no
/// light casts shadows.
LightArray prepareLights(const Scene& scene, const Camera& camera, const ShadowMaps& shadow_maps);

}  // namespace luciole
