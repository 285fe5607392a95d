#pragma once

#include <cstdint>

namespace luciole {

/// What to add to a value, in steps of an integer format, before it is cut off to a whole one: from 1/512 to
/// 511/512 by where the pixel lies in the whole picture, in place of the ½ that rounds. So a slope becomes a
/// fine grain rather than bands, and its mean stays. A value that lies on a step within 1/512, as rounding
/// leaves it, stays on it. All channels have the same: grey stays grey.
///
/// The points of a lattice that fills every neighbourhood evenly (M. Roberts, "The Unreasonable Effectiveness
/// of Quasirandom Sequences", 2018): multiples of 1/ρ and 1/ρ² modulo 1, ρ³ = ρ + 1, in units of 2⁻³².
/// Integers, so the same on every machine.
inline float ditherThreshold(int x, int y) {
  const std::uint32_t place = std::uint32_t(x) * 3242174889u + std::uint32_t(y) * 2447445414u;
  return (float(place >> 24) + 0.5f) * 0x1p-8f;
}

}  // namespace luciole
