#pragma once

#include <algorithm>
#include <cstdint>

namespace luciole {

/// SplitMix64 (Steele, Lea and Flood 2014, "Fast splittable pseudorandom number generators"): the same
/// numbers on every machine. Each call of nextBits adds this step to the state, so adding n steps skips n
/// numbers.
inline constexpr std::uint64_t kRandomStep = 0x9e3779b97f4a7c15u;

/// 64 random bits; advances the state.
inline std::uint64_t nextBits(std::uint64_t& state) {
  std::uint64_t z = state += kRandomStep;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

/// Uniform in [0,1), a multiple of 2⁻⁵³; advances the state.
inline double nextUniform(std::uint64_t& state) {
  return static_cast<double>(nextBits(state) >> 11) * 0x1p-53;
}

/// The number that lies u, in [0,1), of the way from low to high. Rounding never takes it beyond high.
inline double between(double low, double high, double u) { return std::min(low + u * (high - low), high); }

}  // namespace luciole
