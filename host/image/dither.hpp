#pragma once

#include <cstdint>

namespace luciole {

/// The dither threshold of pixel (x, y) of the whole picture, from 1/512 to 511/512. It is added to a value,
/// in steps of an integer format, before the value is truncated, in place of the ½ that rounds. So a gradient
/// becomes fine grain rather than bands, and keeps its mean. A value within 1/512 of a step, as rounding
/// errors leave it, stays on the step. All channels use the same threshold, so grey stays grey.
///
/// From a lattice whose points fill every neighbourhood evenly (M. Roberts, "The Unreasonable Effectiveness
/// of Quasirandom Sequences", 2018): multiples of 1/ρ and 1/ρ² modulo 1, ρ³ = ρ + 1, in units of 2⁻³².
/// Integers, so the same on every machine.
inline float ditherThreshold(int x, int y) {
  const std::uint32_t place = std::uint32_t(x) * 3242174889u + std::uint32_t(y) * 2447445414u;
  return (float(place >> 24) + 0.5f) * 0x1p-8f;
}

}  // namespace luciole
