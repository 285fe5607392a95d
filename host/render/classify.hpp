#pragma once

#include <string>
#include <vector>

#include "base/array_memory.hpp"
#include "render/lookups.hpp"

namespace luciole {

/// See classify.cl.
using PairBits = std::vector<uint, ArrayAllocator<uint>>;

/// Launches kernels/classify.cl: kPairWords words for each entry of the lists, or of all tiles times all
/// lights without lists. texels: `texel_count` of them, at least 1. defines: of lookupFeatures(). Throws
/// MachineError where the words don't fit into memory.
PairBits classify(Device& device, const std::string& defines, const Lookups& lookups,
                  const Buffer<const BoundTexel>& texels, std::size_t texel_count);

}  // namespace luciole
