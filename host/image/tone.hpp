#pragma once

#include <algorithm>

#include "luciole/image.hpp"

namespace luciole {

/// A film's curve for one channel of linear light, before the sRGB transfer: shadows get a toe and highlights
/// a shoulder, and 1 is reached at 7.24. NaN gives 0. K. Narkowicz, "ACES Filmic Tone Mapping Curve", 2016: a
/// fit, within 0.0138, of the Academy Color Encoding System's curve,
///     x (2.51 x + 0.03) / (x (2.43 x + 0.59) + 0.14).
inline float filmicTone(float linear) {
  constexpr float kWhite = 8.0f;  // the fraction is above 1, and larger values could overflow it
  if (!(linear > 0.0f)) return 0.0f;
  const float x = std::min(linear, kWhite);
  return std::min(x * (2.51f * x + 0.03f) / (x * (2.43f * x + 0.59f) + 0.14f), 1.0f);
}

}  // namespace luciole
