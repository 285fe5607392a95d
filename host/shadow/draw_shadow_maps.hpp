#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/index_range.hpp"
#include "scene/scene.hpp"
#include "shadow/shadow_maps.hpp"

namespace luciole {

/// Draws the bins that are needed and weren't drawn yet, from the triangles that can be seen there within the
/// light's range, and no farther away than what looks there. `needed`: one a bin of all faces, the bits of
/// the smallest reversed depth that matters there, or kNotNeeded (see findNeeded). Brings `faces` and
/// `planned` up to date. A face whose rectangle grows gets a new place, to which all its bins are drawn
/// again, with the same texels. Returns the texels that it drew to, of maps.texels or maps.bounds.
std::vector<IndexRange> drawNeeded(const Scene& scene, std::span<const std::uint32_t> needed,
                                   ShadowMaps& maps);

}  // namespace luciole
