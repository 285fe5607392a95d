#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <utility>

#include "luciole/image.hpp"

namespace luciole {

/// Statistics of the bounds of a picture's error (Aov::kLightError), and of actual errors. A value is a
/// channel of a pixel that shows a surface. Bounds and errors are shares of the larger of 1 and the colour,
/// both before exposure, as ShadeSettings::light_error is.
struct KeptBounds {
  double max_bound = 0, mean_bound = 0;  ///< of all values of the picture
  double max_error = 0, mean_error = 0;  ///< of those whose truth is known
  double max_used = 0, mean_used = 0;    ///< of these, error divided by bound: at most 1 if the bounds hold
  std::uint64_t values = 0;              ///< whose truth is known
  std::uint64_t violations = 0;          ///< of these, how many are wrong by more than their bound
  /// The share of the pixels whose truth is known that are right to within their bound. A pixel's channels
  /// err together, so it counts once: by the one of the most light.
  double held = 1;
  double confidence = 1;  ///< the share that is promised, set by who knows it; 1: all values hold
};

/// The figures by the names that files give them.
inline constexpr std::pair<const char*, double KeptBounds::*> kBoundFigures[] = {
    {"max_bound", &KeptBounds::max_bound}, {"mean_bound", &KeptBounds::mean_bound},
    {"max_error", &KeptBounds::max_error}, {"mean_error", &KeptBounds::mean_error},
    {"max_used", &KeptBounds::max_used},   {"mean_used", &KeptBounds::mean_used},
    {"held", &KeptBounds::held},           {"stated", &KeptBounds::confidence}};
inline constexpr std::pair<const char*, std::uint64_t KeptBounds::*> kBoundCounts[] = {
    {"bounded_values", &KeptBounds::values}, {"violations", &KeptBounds::violations}};

/// The channel of the most light.
int brightestChannel(const glm::dvec3& color);

/// Compares a picture with the channels R G B and light_error.R, .G and .B, of one sample a pixel, with the
/// truth. exposure: the picture's, in stops. truth: the linear R G B of each of `pixels` in double, at that
/// exposure. Pixels whose bounds are all 0 show no surface and are left out. O(pixels of the picture).
KeptBounds measureBounds(const Image& picture, float exposure, std::span<const glm::ivec2> pixels,
                         std::span<const glm::dvec3> truth);

/// What bounds break of their promise, for people; empty: nothing. A share of less than 1 may be missed by
/// what chance explains.
std::string brokenPromise(const KeptBounds& kept);

}  // namespace luciole
