#pragma once

#include <string>
#include <vector>

#include "render/lookups.hpp"

namespace luciole {

/// Launches kernels/find_needed.cl: for each bin the reversed depth of the farthest point of the G-buffer
/// that may look at it in shading, as a float's bits, or kNotNeeded. bin_count: of all faces. defines: of
/// lookupFeatures().
std::vector<std::uint32_t> findNeeded(Device& device, const std::string& defines, const Lookups& lookups,
                                      std::size_t bin_count);

}  // namespace luciole
