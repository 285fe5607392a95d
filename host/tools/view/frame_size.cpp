#include "tools/view/frame_size.hpp"

#include <algorithm>
#include <array>

namespace luciole {

void addFrame(const glm::ivec2& size, double milliseconds, FrameCosts& costs) {
  constexpr double kKept = 0.93;  // some 15 frames count
  const double pixels = double(size.x) * size.y;
  for (double* const sum :
       {&costs.weight, &costs.pixels, &costs.milliseconds, &costs.pixels_squared, &costs.pixels_milliseconds})
    *sum *= kKept;
  costs.weight += 1;
  costs.pixels += pixels;
  costs.milliseconds += milliseconds;
  costs.pixels_squared += pixels * pixels;
  costs.pixels_milliseconds += pixels * milliseconds;
}

glm::ivec2 frameSize(const FrameCosts& costs, const glm::ivec2& wanted) {
  constexpr double kFrameTime = 38;  // milliseconds: 40 are 25 a second
  constexpr double kShareOfPixels = 0.25;
  // Few sizes, so that it doesn't change with every frame.
  constexpr std::array kShares{1.0, 0.85, 0.7, 0.6, 0.5, 0.42, 0.35, 0.3, 0.25, 0.2, 0.16, 0.125};
  const auto scaled = [&](double share) {
    return glm::max(glm::ivec2(16), glm::ivec2(glm::round(share * glm::dvec2(wanted))));
  };
  if (costs.weight == 0) return scaled(0.5);
  const double mean_pixels = costs.pixels / costs.weight, mean = costs.milliseconds / costs.weight;
  const double variance = costs.pixels_squared / costs.weight - mean_pixels * mean_pixels;
  const double covariance = costs.pixels_milliseconds / costs.weight - mean_pixels * mean;
  // Frames of one size don't tell what a pixel costs: then it is taken to be half of their time.
  const double known =
      variance > 1e-3 * mean_pixels * mean_pixels ? covariance / variance : 0.5 * mean / mean_pixels;
  const double of_pixel = std::clamp(known, 0.05 * mean / mean_pixels, mean / mean_pixels);
  const double fixed = std::max(0.0, mean - of_pixel * mean_pixels);
  const double time = std::max(kFrameTime - fixed, kShareOfPixels / (1 - kShareOfPixels) * fixed);
  for (const double share : kShares) {
    const glm::ivec2 size = scaled(share);
    if (of_pixel * size.x * size.y <= time) return size;
  }
  return scaled(kShares.back());
}

}  // namespace luciole
