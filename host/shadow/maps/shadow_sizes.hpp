#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "luciole/settings.hpp"
#include "shadow/maps/shadow_views.hpp"

namespace luciole {

/// Texels a side of each light's faces; 0: no shadow.
struct ShadowSizes {
  std::vector<int> sizes;            ///< one a light of the scene
  std::uint64_t reduced_lights = 0;  ///< lights with fewer than wanted, for lack of memory
};

/// Chooses the sizes of all lights' faces. Directional lights get as many texels as the limits allow. For
/// other lights a texel halfway to their reach is about as large as a pixel of the whole picture there. If
/// that exceeds limits.bytes, all faces are scaled down by one factor, to kSmallestFace texels a side at the
/// least. Throws MachineError if even that is too much.
ShadowSizes chooseSizes(const Scene& scene, const PlanInput& input, const ShadowLimits& limits);

}  // namespace luciole
