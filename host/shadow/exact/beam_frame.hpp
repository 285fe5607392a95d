#pragma once

#include <cstddef>

#include "kernels/shared.h"
#include "shadow/exact/beam_shadows.hpp"

namespace luciole {

/// What kernels need to bring points of view space to the tree's. plane_stride: floats in a plane of the
/// G-buffer.
BeamFrame beamFrame(const BeamScene& beams, std::size_t plane_stride);

}  // namespace luciole
