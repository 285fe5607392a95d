#pragma once

#include "kernels/shared.h"
#include "lights/cull.hpp"

namespace luciole {

struct CountInRangeArguments {
  Buffer<const float> position;  ///< G-buffer planes x, y, z; view space, metres
  std::size_t plane_stride;      ///< floats in a plane
  Buffer<const ShadeLight> lights;
  const LightLists& lists;  ///< culled with kByRange
  Buffer<float> counts;     ///< out: plane_stride
};

/// Launches kernels/lights/count_in_range.cl: counts for each pixel the lights in whose range it lies.
/// Doesn't wait. Throws MachineError.
void countInRange(OpenedDevice& device, const CountInRangeArguments& arguments);

}  // namespace luciole
