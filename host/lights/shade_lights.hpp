#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kernels/shared.h"
#include "luciole/array_memory.hpp"
#include "luciole/scene.hpp"

namespace luciole {

/// Lights of the scene as kernels take them: in the camera's view space, in the order of these indices. A
/// light so far away that its squared distance would overflow a float is moved nearer, with its falloff
/// scaled to match. map_of_light: of each of the scene's lights (see ShadowMaps); empty if none casts
/// shadows.
RawArray<ShadeLight> prepareLights(const Scene& scene, std::span<const std::uint32_t> order,
                                   const Camera& camera, std::span<const std::uint32_t> map_of_light);

/// All of the scene's lights, in the order of spatialOrder().
RawArray<ShadeLight> prepareLights(const Scene& scene, const Camera& camera,
                                   std::span<const std::uint32_t> map_of_light);

}  // namespace luciole
