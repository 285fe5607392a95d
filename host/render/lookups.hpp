#pragma once

#include <vector>

#include "cl/launch.hpp"
#include "culling/cull.hpp"
#include "kernels/shared.h"

namespace luciole {

/// The points of a G-buffer and the lights that they look up shadows of: what classify.cl and find_needed.cl
/// both read.
struct Lookups {
  std::size_t plane_stride;      ///< floats
  Buffer<const float> position;  ///< G-buffer planes x, y, z
  Buffer<const float> normal;    ///< likewise
  Buffer<const float> lift;      ///< one plane, with Feature::kLift only
  Buffer<const ShadeLight> lights;
  std::size_t light_count;
  const LightLists& lists;  ///< with Feature::kLightLists only
  Buffer<const ShadowMap> shadow_maps;
  Buffer<const ShadowFace> shadow_faces;
};

/// Their arguments, by the names that both kernels give them.
std::vector<KernelArgument> lookupArguments(const Lookups& lookups);

}  // namespace luciole
