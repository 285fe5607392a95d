#pragma once

#include "cl/buffer.hpp"
#include "kernels/shared.h"

namespace luciole {

/// Light lists on the device: tile i has the entries [starts[i], starts[i + 1]) of `list`. The buffers may be
/// larger than stated; elements beyond that are undefined.
struct LightLists {
  Buffer<uint> starts;      ///< tiles + 1
  Buffer<ListEntry> list;   ///< `entries`; in a tile ascending by light
  Buffer<ListEntry> found;  ///< kFoundPerTile for each tile: entries that the counting pass keeps for filling
  std::size_t tiles = 0;
  std::size_t entries = 0;
  std::size_t bytes = 0;  ///< of the three buffers that these lists use
};

struct CullArguments {
  Buffer<const float> position;  ///< G-buffer planes x, y, z; view space, metres
  Buffer<const float> normal;    ///< G-buffer planes x, y, z; view space, unit
  std::size_t plane_stride;      ///< floats in a plane, a multiple of kTilePixels
  unsigned group_log2;           ///< 4, 6 or 8: lights are tested against 1 << group_log2 pixels at a time
  Buffer<const ShadeLight> lights;
  std::size_t light_count;
  Buffer<const float> tree;  ///< see LightTree
  std::size_t tree_stride;   ///< floats
  unsigned tests;            ///< kByRange, or kByCone | kByFacing, or one of them
};

/// CullArguments::group_log2 for squares of 4, 8 or 16 pixels a side.
constexpr unsigned groupLog2(int tile_size) { return tile_size == 4 ? 4 : tile_size == 8 ? 6 : 8; }

/// Launches kernels/lights/cull.cl and waits for it: lists for each tile the lights that may light a point in
/// it. As long as no light gives ambient light or `tests` lacks kByFacing, it leaves out only lights to which
/// shading would add exactly zero. Reuses the buffers of `lists` that are large enough. Throws MachineError,
/// also for lists of more than 2³² − 2 entries.
void cull(OpenedDevice& device, const CullArguments& arguments, LightLists& lists);

}  // namespace luciole
