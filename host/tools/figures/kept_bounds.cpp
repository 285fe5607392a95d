#include "tools/figures/kept_bounds.hpp"

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

double meanOf(double sum, std::uint64_t count) { return count > 0 ? sum / double(count) : 0; }

}  // namespace

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
  std::uint64_t values = 0;
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
    for (int c = 0; c < 3; ++c) {
      // Colours end at the largest float.
      const double right = std::min(truth[i][c], double(std::numeric_limits<float>::max()));
      const double value = pixel.color[c], error = std::abs(value - right);
      const double share = error / std::max(white, value), use = error / double(pixel.bound[c]);
      // Neither holds for an error that is no number.
      if (!(error <= double(pixel.bound[c]))) ++kept.violations;
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
  return kept;
}

}  // namespace luciole
