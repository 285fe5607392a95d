#pragma once

#include "cl/buffer.hpp"
#include "kernels/shared.h"

namespace luciole {

/// Light lists on the device: tile i has the entries [starts[i], starts[i + 1]) of `list`. The buffers may
/// hold more than that, and what lies behind is undefined.
struct LightLists {
  Buffer<uint> starts;      ///< tiles + 1
  Buffer<ListEntry> list;   ///< entries, lights ascending in a tile
  Buffer<ListEntry> found;  ///< what counting found: kFoundPerTile a tile
  std::size_t tiles = 0;
  std::size_t entries = 0;
  std::size_t bytes = 0;  ///< that the lists take of all three
};

struct CullArguments {
  Buffer<const float> position;  ///< G-buffer planes x, y, z
  Buffer<const float> normal;    ///< likewise
  std::size_t plane_stride;      ///< floats
  unsigned group_log2;           ///< 4, 6 or 8: lights are kept apart by squares of 1 << shift pixels
  Buffer<const ShadeLight> lights;
  std::size_t light_count;
  Buffer<const float> tree;  ///< see LightTree
  std::size_t tree_stride;   ///< floats
  unsigned tests;            ///< kByRange and more
};

/// Launches kernels/cull.cl: for each tile the lights that may light a point in it, in the order of light
/// indices. With the right tests it leaves out only lights that shading would find to contribute exactly
/// zero. The lists go to the buffers that `lists` has, where these are large enough. Throws MachineError,
/// also where the lists would have more than 2³² − 2 entries.
void cull(Device& device, const CullArguments& arguments, LightLists& lists);

}  // namespace luciole
