#pragma once

#include <string>
#include <vector>

#include "shadow/maps/lookups.hpp"

namespace luciole {

/// Launches kernels/maps/find_needed.cl and waits for it. Returns for each bin the reversed depth, as a
/// float's bits, of the point of the G-buffer farthest from the light whose lookup may read the bin;
/// kNotNeeded if there is none. bin_count: of all faces together. defines: of featuresFor(kForLookups).
/// Throws MachineError.
std::vector<std::uint32_t> findNeeded(OpenedDevice& device, const std::string& defines,
                                      const Lookups& lookups, std::size_t bin_count);

}  // namespace luciole
