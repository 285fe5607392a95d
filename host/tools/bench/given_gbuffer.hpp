#pragma once

#include "tools/bench/speed_input.hpp"
#include "tools/bench/speed_table.hpp"

namespace luciole {

/// Measures culling and shading alone, from prepared planes and lights to float colours, on the G-buffer of
/// the input. Beside it, in the same rounds: the roof, which computes as many pairs with nothing to load or
/// to wait for (tests/kernels/roof.cl), and a copy that moves as many bytes. Throws MachineError.
SpeedTable measureGivenGBuffer(const SpeedInput& input);

}  // namespace luciole
