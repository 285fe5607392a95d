#pragma once

#include <string>
#include <vector>

#include "culling/cull.hpp"
#include "kernels/shared.h"

namespace luciole {

struct FindNeededArguments {
  std::size_t plane_stride;      ///< floats
  Buffer<const float> position;  ///< G-buffer planes x, y, z
  Buffer<const float> normal;    ///< likewise
  Buffer<const float> lift;      ///< one plane, with Feature::kLift only
  Buffer<const ShadeLight> lights;
  std::size_t light_count;
  const LightLists& lists;  ///< with Feature::kLightLists only
  Buffer<const ShadowMap> shadow_maps;
  Buffer<const ShadowFace> shadow_faces;
  std::size_t bin_count;  ///< of all faces
};

/// Launches kernels/find_needed.cl: for each bin the reversed depth of the farthest point of the G-buffer
/// that may look at it in shading, as a float's bits, or kNotNeeded. defines: of lookupFeatures().
std::vector<std::uint32_t> findNeeded(Device& device, const std::string& defines,
                                      const FindNeededArguments& arguments);

}  // namespace luciole
