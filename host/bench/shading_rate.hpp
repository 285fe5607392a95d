#pragma once

#include "bench/speed_input.hpp"
#include "bench/speed_table.hpp"
#include "gbuffer/gbuffer.hpp"
#include "image/image.hpp"

namespace luciole {

/// Surfaces and lights of which every pair counts: all in range, all facing each other, highlights of
/// exponents 1 to 100.
struct AllPairs {
  Scene scene;  ///< lights only
  GBuffer gbuffer;
};
AllPairs makeAllPairs(glm::ivec2 size, int lights);

/// The picture by tests/kernels/plain.cl, channels R G B.
Image shadePlainly(Device& device, const AllPairs& pairs);

/// How many pairs of pixel and light our kernel shades a second where nothing is culled, beside the plain
/// kernel and beside the roof: the rate at which the vector units could issue our kernel's instructions.
SpeedTable measureShadingRate(const SpeedInput& input);

}  // namespace luciole
