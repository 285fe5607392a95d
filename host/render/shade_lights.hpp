#pragma once

#include <vector>

#include "kernels/shared.h"
#include "raster/gbuffer.hpp"
#include "scene/scene.hpp"
#include "shadow/shadow_maps.hpp"

namespace luciole {

/// The scene's lights as the kernels take them.
struct ShadeLights {
  std::vector<ShadeLight> lights;  ///< in the order of scene.lights
  /// What culling needs of them: planes x, y, z (view space) and 1 / range² of reach_stride floats each.
  /// Padded to whole rows of lanes with lights that reach nothing.
  Plane reach;
  std::size_t reach_stride = 0;
};

/// Brings the lights into the camera's view space. shadow_maps: empty where no light casts shadows.
ShadeLights prepareLights(const Scene& scene, const Camera& camera, const ShadowMaps& shadow_maps);

}  // namespace luciole
