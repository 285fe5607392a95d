#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "cl/device.hpp"
#include "culling/cull.hpp"
#include "gbuffer/gbuffer.hpp"
#include "kernels/shared.h"
#include "rays/ray_cast.hpp"
#include "scene/scene.hpp"

namespace luciole {

struct ClassifyArguments {
  std::size_t plane_stride;    ///< floats
  const cl::Buffer& position;  ///< G-buffer planes x, y, z
  const cl::Buffer& normal;    ///< likewise
  const cl::Buffer& lift;      ///< one plane, with Feature::kLift only
  const cl::Buffer& lights;    ///< ShadeLight[light_count]
  std::size_t light_count;
  const LightLists& lists;         ///< with Feature::kLightLists only
  const cl::Buffer& shadow_maps;   ///< ShadowMap[]
  const cl::Buffer& shadow_faces;  ///< ShadowFace[]
  const cl::Buffer& bounds;        ///< BoundTexel[texel_count]
  std::size_t texel_count;
};

using PairBits = std::vector<cl_uint, ArrayAllocator<cl_uint>>;

/// Launches kernels/classify.cl: kPairWords words for each entry of the lists, or of all tiles times all
/// lights without lists. defines: of lookupFeatures(). Throws MachineError where they don't fit into memory.
PairBits classify(Device& device, const std::string& defines, const ClassifyArguments& arguments);

/// Decides the pairs that are unsure by rays (see buildShadowRays): the bits of those that are lit are set
/// too. order: the scene's index of each of the device's lights. Returns how many there were.
std::uint64_t traceUnsure(Device& device, const Scene& scene, const RayScene& rays, const GBuffer& gbuffer,
                          std::span<const std::uint32_t> order, const LightLists& lists, PairBits& bits);

}  // namespace luciole
