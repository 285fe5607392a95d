#pragma once

#include "cl/device.hpp"
#include "kernels/shared.h"

namespace luciole {

/// Light lists on the device: tile i has the entries [starts[i], starts[i + 1]) of `list`.
struct LightLists {
  cl::Buffer starts;  ///< tiles + 1 uints
  cl::Buffer list;    ///< ListEntry[entries], lights ascending in a tile
  std::size_t tiles = 0;
  std::size_t entries = 0;
  std::size_t bytes = 0;  ///< of both buffers and what counting found
};

struct CullArguments {
  const cl::Buffer& position;  ///< G-buffer planes x, y, z
  const cl::Buffer& normal;    ///< likewise
  std::size_t plane_stride;    ///< floats
  unsigned shift;              ///< 4, 6 or 8: lights are kept apart by squares of 1 << shift pixels
  const cl::Buffer& lights;    ///< ShadeLight[light_count]
  std::size_t light_count;
  const cl::Buffer& tree;  ///< see LightTree
  std::size_t tree_stride;
  unsigned tests;  ///< kByRange and more
};

/// Launches kernels/cull.cl: for each tile the lights that may light a point in it, in the order of light
/// indices. With the right tests it leaves out only lights that shading would find to contribute exactly
/// zero. Throws MachineError, also where the lists would have more than 2³² − 2 entries.
LightLists cull(Device& device, const CullArguments& arguments);

}  // namespace luciole
