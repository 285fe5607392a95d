#pragma once

#include <vector>

#include "base/array_memory.hpp"
#include "kernels/shared.h"
#include "scene/scene.hpp"
#include "shadow/shadow_maps.hpp"

namespace luciole {

/// New elements are not cleared.
using LightArray = std::vector<ShadeLight, RawArrayAllocator<ShadeLight>>;

/// The scene's lights as kernels see them: in the camera's view space, in the order of spatialOrder(). A
/// light whose squared distance would overflow a float is moved nearer, with its falloff scaled to match.
/// shadow_maps: empty if no light casts shadows.
LightArray prepareLights(const Scene& scene, const Camera& camera, const ShadowMaps& shadow_maps);

}  // namespace luciole
