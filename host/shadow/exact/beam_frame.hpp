#pragma once

#include <cstddef>
#include <vector>

#include "cl/launch.hpp"
#include "kernels/shared.h"
#include "shadow/exact/beam_shadows.hpp"

namespace luciole {

/// What kernels need to bring points of view space to the tree's. plane_stride: floats in a plane of the
/// G-buffer.
BeamFrame beamFrame(const BeamScene& beams, std::size_t plane_stride);

/// The arguments for launch() of a kernel that walks the triangle tree: `others`, and the tree's buffers.
std::vector<KernelArgument> withTriangleTree(const BeamScene& beams, std::vector<KernelArgument> others);

}  // namespace luciole
