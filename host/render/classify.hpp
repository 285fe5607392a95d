#pragma once

#include <string>
#include <vector>

#include "base/array_memory.hpp"
#include "render/lookups.hpp"

namespace luciole {

/// The words of classify.cl: kPairWords for each entry of the light lists.
using PairBits = std::vector<uint, ArrayAllocator<uint>>;

/// Launches kernels/classify.cl and waits for it. Returns kPairWords words for each entry of the lists;
/// without lists for each tile and light, tile by tile. texels: `texel_count` of them, at least 1. defines:
/// of lookupFeatures(). Throws MachineError, also if the words don't fit into memory or there are 2²⁸
/// entries.
PairBits classify(Device& device, const std::string& defines, const Lookups& lookups,
                  const Buffer<const BoundTexel>& texels, std::size_t texel_count);

}  // namespace luciole
