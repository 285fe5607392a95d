#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/index_range.hpp"
#include "luciole/scene.hpp"
#include "shadow/maps/shadow_maps.hpp"

namespace luciole {

/// Draws the bins of shadow maps that lookups need and that aren't drawn yet, from the meshlets that show
/// there within the light's range. `needed`: one a bin of all faces, the bits of the smallest reversed depth
/// that matters there, or kNotNeeded (see findNeeded); what is farther away may be left out. Updates `faces`
/// and `planned`. A face whose rectangle grows gets a new place, to which what was drawn is copied, or where
/// memory is short is drawn again, with the same texels. Returns the ranges that it drew of maps.texels.
/// Faces are drawn in parallel. Throws as rasterizeDepth does.
std::vector<IndexRange> drawNeeded(const Scene& scene, std::span<const std::uint32_t> needed,
                                   ShadowMaps& maps);

}  // namespace luciole
