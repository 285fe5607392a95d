#pragma once

#include <string>
#include <vector>

#include "cl/device.hpp"
#include "culling/cull.hpp"
#include "kernels/shared.h"

namespace luciole {

struct FindNeededArguments {
  std::size_t plane_stride;    ///< floats
  const cl::Buffer& position;  ///< G-buffer planes x, y, z
  const cl::Buffer& normal;    ///< likewise
  const cl::Buffer& lift;      ///< one plane, with Feature::kLift only
  const cl::Buffer& lights;    ///< ShadeLight[light_count]
  std::size_t light_count;
  const LightLists& lists;         ///< with Feature::kLightLists only
  const cl::Buffer& shadow_maps;   ///< ShadowMap[]
  const cl::Buffer& shadow_faces;  ///< ShadowFace[]
  std::size_t bin_count;           ///< of all faces
};

/// Launches kernels/find_needed.cl: for each bin the reversed depth of the farthest point of the G-buffer
/// that may look at it in shading, as a float's bits, or kNotNeeded. defines: of lookupFeatures().
std::vector<std::uint32_t> findNeeded(Device& device, const std::string& defines,
                                      const FindNeededArguments& arguments);

}  // namespace luciole
