#pragma once

#include "luciole/gbuffer.hpp"
#include "luciole/image.hpp"
#include "tools/bench/speed_input.hpp"
#include "tools/bench/speed_table.hpp"

namespace luciole {

/// Surfaces and lights of which every pair counts: all lights are in range of all surfaces and in front of
/// them. Highlights have exponents from 1 to 100.
struct AllPairs {
  Scene scene;  ///< lights only
  GBuffer gbuffer;
};
AllPairs makeAllPairs(glm::ivec2 size, int lights);

/// The picture made by tests/kernels/plain.cl, channels R G B. Throws MachineError.
Image shadePlainly(OpenedDevice& device, const AllPairs& pairs);

/// Milliseconds that the roof takes for these pairs (see measureShadingRate). The first run for a device
/// compiles. Throws MachineError.
double roofMilliseconds(OpenedDevice& device, const AllPairs& pairs);

/// Measures how many pairs of a pixel and a light the shade kernel computes in a second if nothing is culled,
/// beside the plain kernel and the roof: the rate at which the vector units could issue the shade kernel's
/// instructions (tests/kernels/roof.cl). Throws MachineError.
SpeedTable measureShadingRate(const SpeedInput& input);

}  // namespace luciole
