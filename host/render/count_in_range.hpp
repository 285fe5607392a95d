#pragma once

#include "culling/cull.hpp"
#include "kernels/shared.h"

namespace luciole {

struct CountInRangeArguments {
  Buffer<const float> position;  ///< G-buffer planes x, y, z
  std::size_t plane_stride;      ///< floats
  Buffer<const ShadeLight> lights;
  const LightLists& lists;
  Buffer<float> counts;  ///< out: one a pixel
};

/// Launches kernels/count_in_range.cl: how many lights reach each pixel.
void countInRange(Device& device, const CountInRangeArguments& arguments);

}  // namespace luciole
