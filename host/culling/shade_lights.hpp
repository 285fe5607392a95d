#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/array_memory.hpp"
#include "kernels/shared.h"
#include "scene/scene.hpp"
#include "shadow/shadow_maps.hpp"

namespace luciole {

/// New elements are not cleared.
using LightArray = std::vector<ShadeLight, RawArrayAllocator<ShadeLight>>;

/// Lights of the scene as kernels see them: in the camera's view space, in the order of these indices. A
/// light whose squared distance would overflow a float is moved nearer, with its falloff scaled to match.
/// shadow_maps: empty if no light casts shadows.
LightArray prepareLights(const Scene& scene, std::span<const std::uint32_t> order, const Camera& camera,
                         const ShadowMaps& shadow_maps);

/// All of the scene's lights, in the order of spatialOrder().
LightArray prepareLights(const Scene& scene, const Camera& camera, const ShadowMaps& shadow_maps);

}  // namespace luciole
