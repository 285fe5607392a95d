#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/index_range.hpp"
#include "luciole/scene.hpp"
#include "shadow/maps/shadow_maps.hpp"

namespace luciole {

/// Draws the bins of shadow maps that lookups need and that aren't drawn yet. Uses the meshlets that are
/// visible there within the light's range. `needed`: for each bin of all faces the bits of the smallest
/// reversed depth that matters there, or kNotNeeded (see findNeeded); farther surfaces may be missing.
/// Updates `faces` and `planned`. A face whose rectangle grows gets a new place. Its texels are copied there,
/// or drawn again if memory is short; they are the same either way. Returns the ranges of maps.texels that
/// changed. Faces are drawn in parallel. Throws as rasterizeDepth does.
std::vector<IndexRange> drawNeeded(const Scene& scene, std::span<const std::uint32_t> needed,
                                   ShadowMaps& maps);

}  // namespace luciole
