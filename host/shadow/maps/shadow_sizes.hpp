#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "scene/scene.hpp"
#include "shadow/maps/shadow_views.hpp"

namespace luciole {

/// How much shadow maps may take.
struct ShadowLimits {
  int size = 2048;  ///< texels a side of a cascade and of a spot's map; a cube's face: half
  std::size_t bytes = std::size_t(512) << 20;  ///< of all maps together
};

/// Texels a side: the fewest of a face, and the most that ShadowLimits::size may ask for.
inline constexpr int kSmallestFace = 16, kLargestFace = 16384;

/// Texels a side of each light's faces; 0: no shadow.
struct ShadowSizes {
  std::vector<int> sizes;            ///< one a light of the scene
  std::uint64_t reduced_lights = 0;  ///< lights with fewer than wanted, for lack of memory
};

/// Chooses the sizes of all lights' faces. Directional lights get as many texels as the limits allow. For
/// other lights a texel halfway to their reach is about as large as a pixel of the whole picture there,
/// whatever the crop. Where that exceeds
/// limits.bytes all faces get coarser alike, down to kSmallestFace texels a side. Throws MachineError if even
/// that is too much.
ShadowSizes chooseSizes(const Scene& scene, const PlanInput& input, const ShadowLimits& limits);

}  // namespace luciole
