#pragma once

#include "cl/device.hpp"
#include "kernels/shared.h"

namespace luciole {

/// Light lists on the device: tile t has entries [starts[t], starts[t + 1]) of `list`.
struct LightLists {
  cl::Buffer starts;  ///< tiles + 1 uints
  cl::Buffer list;    ///< entries uints, ascending in a tile
  std::size_t entries = 0;
  std::size_t bytes = 0;  ///< of both buffers and the tiles' bounds
};

struct CullArguments {
  const cl::Buffer& position;  ///< G-buffer planes x, y, z
  std::size_t plane_stride;    ///< floats
  const cl::Buffer& reach;     ///< see ShadeLights::reach
  std::size_t reach_stride;    ///< floats
};

/// Launches kernels/cull.cl: for each tile the lights that may reach a point in it, in the order of light
/// indices. Leaves out only lights that shading would find to contribute exactly zero. Throws MachineError,
/// also where the lists would have more than 2³² − 2 entries.
LightLists cull(Device& device, const CullArguments& arguments);

}  // namespace luciole
