#pragma once

#include <vector>

#include "cl/launch.hpp"
#include "kernels/shared.h"
#include "lights/cull.hpp"

namespace luciole {

/// The points of a G-buffer and the lights whose shadow maps they look up, for find_needed.cl.
struct Lookups {
  std::size_t plane_stride;      ///< floats in a plane
  Buffer<const float> position;  ///< G-buffer planes x, y, z; view space, metres
  Buffer<const float> normal;    ///< G-buffer planes x, y, z; view space, unit
  Buffer<const float> lift;      ///< a plane, metres, with Feature::kLift only
  Buffer<const ShadeLight> lights;
  std::size_t light_count;
  const LightLists& lists;  ///< with Feature::kLightLists only
  Buffer<const ShadowMap> shadow_maps;
  Buffer<const ShadowFace> shadow_faces;
};

/// These as arguments for launch(), by the names that the kernel gives them.
std::vector<KernelArgument> lookupArguments(const Lookups& lookups);

}  // namespace luciole
