#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "scene/scene.hpp"
#include "shadow/shadow_views.hpp"

namespace luciole {

/// How much shadow maps may take.
struct ShadowLimits {
  int size = 2048;  ///< texels a side of a cascade and of a spot's map; a cube's face: half
  std::size_t bytes = std::size_t(512) << 20;  ///< of all maps together
};

/// Texels a side: faces have no fewer, and limits ask for no more.
inline constexpr int kSmallestFace = 16, kLargestFace = 16384;

/// Texels a side of each light's faces; 0: no shadow.
struct ShadowSizes {
  std::vector<int> sizes;            ///< one a light of the scene
  std::uint64_t reduced_lights = 0;  ///< have fewer than wanted, since the memory ends
};

/// - Directional lights want as many texels as the limits allow.
/// - The others want a texel that is about as large as a pixel of the whole picture, whatever the crop,
/// halfway
///   to the end of their reach.
/// Where that exceeds limits.bytes all maps get coarser, down to kSmallestFace texels a side. Throws
/// MachineError if even that is too much.
ShadowSizes chooseSizes(const Scene& scene, const PlanInput& input, const ShadowLimits& limits);

}  // namespace luciole
