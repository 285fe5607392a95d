#include "tools/figures/kept_bounds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace luciole {
namespace {

/// A pixel's colour, and how far it may be from the truth.
struct BoundedColor {
  const float* color;
  const float* bound;

  bool showsSurface() const { return bound[0] > 0 || bound[1] > 0 || bound[2] > 0; }
};

/// A confidence of 0.99 is that of 0.985 at the worst: samples tell the error of their sum, and that has one
/// of its own.
constexpr double kTolerance = 1.5;
/// Standard deviations of a number of misses that are chance. As many misses more are so where few are
/// expected, which no normal distribution describes.
constexpr double kDeviations = 3;

double meanOf(double sum, std::uint64_t count) { return count > 0 ? sum / double(count) : 0; }

}  // namespace

int brightestChannel(const glm::dvec3& color) {
  return color.x >= color.y && color.x >= color.z ? 0 : color.y >= color.z ? 1 : 2;
}

KeptBounds measureBounds(const Image& picture, float exposure, std::span<const glm::ivec2> pixels,
                         std::span<const glm::dvec3> truth) {
  const std::size_t stride = picture.channels.size();
  const auto channel = [&](const char* name) {
    return std::size_t(std::find(picture.channels.begin(), picture.channels.end(), name) -
                       picture.channels.begin());
  };
  const std::size_t color = channel("R"), bound = channel("light_error.R");
  const auto pixelAt = [&](std::size_t place) {
    const float* pixel = picture.pixels.data() + place * stride;
    return BoundedColor{pixel + color, pixel + bound};
  };
  const double white = std::exp2(double(exposure));
  KeptBounds kept;
  double bounds = 0, errors = 0, used = 0;
  std::uint64_t values = 0, held = 0;
  for (std::size_t place = 0; place < picture.pixels.size() / stride; ++place) {
    const BoundedColor pixel = pixelAt(place);
    if (!pixel.showsSurface()) continue;
    for (int c = 0; c < 3; ++c) {
      const double share = double(pixel.bound[c]) / std::max(white, double(pixel.color[c]));
      kept.max_bound = std::max(kept.max_bound, share);
      bounds += share;
    }
    values += 3;
  }
  kept.mean_bound = meanOf(bounds, values);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const BoundedColor pixel = pixelAt(std::size_t(pixels[i].y) * picture.width + pixels[i].x);
    if (!pixel.showsSurface()) continue;
    const int most = brightestChannel(truth[i]);
    for (int c = 0; c < 3; ++c) {
      // Colours end at the largest float.
      const double right = std::min(truth[i][c], double(std::numeric_limits<float>::max()));
      const double value = pixel.color[c], error = std::abs(value - right);
      const double share = error / std::max(white, value), use = error / double(pixel.bound[c]);
      // Neither holds for an error that is no number.
      const bool holds = error <= double(pixel.bound[c]);
      if (!holds) ++kept.violations;
      if (holds && c == most) ++held;
      if (error == 0) continue;
      kept.max_error = std::max(kept.max_error, share);
      kept.max_used = std::max(kept.max_used, use);
      errors += share;
      used += use;
    }
    kept.values += 3;
  }
  kept.mean_error = meanOf(errors, kept.values);
  kept.mean_used = meanOf(used, kept.values);
  if (kept.values > 0) kept.held = double(held) / double(kept.values / 3);
  return kept;
}

std::string brokenPromise(const KeptBounds& kept) {
  if (kept.confidence == 1)
    return kept.violations == 0 ? ""
                                : fmt::format("{} of {} values are wrong by more than their bounds",
                                              kept.violations, kept.values);
  const std::uint64_t pixels = kept.values / 3;
  const double missed = (1 - kept.held) * double(pixels);
  const double expected = kTolerance * (1 - kept.confidence) * double(pixels);
  if (missed <= expected + kDeviations * std::sqrt(expected) + kDeviations) return "";
  return fmt::format("{:.2f} % of {} pixels are within intervals that shall hold for {:g} %", 100 * kept.held,
                     pixels, 100 * kept.confidence);
}

}  // namespace luciole
