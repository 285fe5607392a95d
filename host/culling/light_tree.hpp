#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "gbuffer/gbuffer.hpp"
#include "kernels/shared.h"
#include "scene/scene.hpp"

namespace luciole {

/// Lights in an order that keeps neighbours together: those that reach everywhere first, then by the binary
/// order of magnitude of their range, then along a Z curve (G. Morton, 1966) through the box around them.
/// It depends on the lights alone, not on who looks at them.
std::vector<std::uint32_t> spatialOrder(std::span<const Light> lights);

/// The tree over the lights that kernels/cull.cl walks, and draws.
struct LightTree {
  Plane planes;            ///< low x y z, high x y z, 1 / range² of `stride` floats each
  std::size_t stride = 0;  ///< nodes of all levels, paddings included
};

/// lights: as the kernels see them, in the order in which they are shaded.
LightTree buildLightTree(std::span<const ShadeLight> lights);

}  // namespace luciole
