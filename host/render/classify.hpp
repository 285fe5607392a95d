#pragma once

#include <string>
#include <vector>

#include "base/array_memory.hpp"
#include "culling/cull.hpp"
#include "kernels/shared.h"

namespace luciole {

struct ClassifyArguments {
  std::size_t plane_stride;      ///< floats
  Buffer<const float> position;  ///< G-buffer planes x, y, z
  Buffer<const float> normal;    ///< likewise
  Buffer<const float> lift;      ///< one plane, with Feature::kLift only
  Buffer<const ShadeLight> lights;
  std::size_t light_count;
  const LightLists& lists;  ///< with Feature::kLightLists only
  Buffer<const ShadowMap> shadow_maps;
  Buffer<const ShadowFace> shadow_faces;
  Buffer<const BoundTexel> texels;
  std::size_t texel_count;  ///< at least 1
};

/// See classify.cl.
using PairBits = std::vector<uint, ArrayAllocator<uint>>;

/// Launches kernels/classify.cl: kPairWords words for each entry of the lists, or of all tiles times all
/// lights without lists. defines: of lookupFeatures(). Throws MachineError where they don't fit into memory.
PairBits classify(Device& device, const std::string& defines, const ClassifyArguments& arguments);

}  // namespace luciole
