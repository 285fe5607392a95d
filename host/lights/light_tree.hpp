#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kernels/shared.h"
#include "luciole/array_memory.hpp"
#include "luciole/scene.hpp"

namespace luciole {

/// Indices of the lights in an order that keeps neighbours together: lights that reach everywhere first, then
/// by the binary exponent of their range, then along a Z curve (G. Morton, 1966) through the box around
/// them. It doesn't depend on the camera. O(n), on all cores.
std::vector<std::uint32_t> spatialOrder(std::span<const Light> lights);

/// The tree over the lights that kernels/lights/cull.cl walks; a drawing of it is there.
struct LightTree {
  /// Low x y z, high x y z, 1 / range²: 7 planes of `stride` floats each.
  RawArray<float> planes;
  std::size_t stride = 0;  ///< nodes of all levels, padding included
};

/// The tree over lights in the order of spatialOrder(); view space. O(n), on all cores; 28 bytes a node,
/// 16/15 nodes a light.
LightTree buildLightTree(std::span<const ShadeLight> lights);

}  // namespace luciole
