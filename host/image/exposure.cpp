#include "image/exposure.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "image/light_names.hpp"

namespace luciole {
namespace {

constexpr double kKey = 0.18;
constexpr std::uint64_t kLeftOutPercent = 10;  ///< at each end
constexpr int kLongestSide = 256;

// Luminances are counted in bins, which makes the result exact whatever their order. A bin holds the floats
// that share their exponent and the first 7 bits of their mantissa: 128 bins an octave, and the middle of a
// bin is within 0.006 stops of all in it.
constexpr int kDroppedBits = 16;
constexpr std::size_t kLuminanceBins = std::size_t(0x7f800000) >> kDroppedBits;  // below infinity

double middleOf(std::size_t bin) {
  constexpr std::uint32_t kHalf = std::uint32_t(1) << (kDroppedBits - 1);
  return std::bit_cast<float>((std::uint32_t(bin) << kDroppedBits) + kHalf);
}

/// Of linear Rec.709. NaN for a colour with a NaN.
double luminance(const glm::vec3& color) {
  return 0.2126 * double(color.r) + 0.7152 * double(color.g) + 0.0722 * double(color.b);
}

}  // namespace

double suitableExposure(std::span<const glm::vec3> colors) {
  constexpr double kLargest = std::numeric_limits<float>::max();
  std::vector<std::uint64_t> counts(kLuminanceBins);
  std::uint64_t lit = 0;
  for (const glm::vec3& color : colors) {
    const double value = luminance(color);
    const float rounded = value > 0 ? float(std::min(value, kLargest)) : 0.0f;
    if (rounded == 0) continue;
    ++counts[std::bit_cast<std::uint32_t>(rounded) >> kDroppedBits];
    ++lit;
  }
  if (lit == 0) return 0;
  const std::uint64_t first = lit * kLeftOutPercent / 100, end = lit - first;
  double sum = 0;
  std::uint64_t before = 0;
  for (std::size_t bin = 0; bin < counts.size(); ++bin) {
    const std::uint64_t after = before + counts[bin];
    const std::uint64_t low = std::max(before, first), high = std::min(after, end);
    if (low < high) sum += double(high - low) * std::log2(middleOf(bin));
    before = after;
  }
  const double stops = std::log2(kKey) - sum / double(end - first);
  return std::clamp(std::round(100 * stops) / 100, -kMostStops, kMostStops) + 0.0;  // never -0
}

glm::ivec2 measuringSize(glm::ivec2 picture_size) {
  const int longest = std::max(picture_size.x, picture_size.y);
  if (longest <= kLongestSide) return picture_size;
  const auto shrunk = [&](int side) {
    return std::max(int(std::lround(double(side) * kLongestSide / longest)), 1);
  };
  return {shrunk(picture_size.x), shrunk(picture_size.y)};
}

void expose(Image& image, double stops) {
  constexpr float kLargest = std::numeric_limits<float>::max();
  const float scale = std::exp2(float(stops));
  const std::size_t channels = image.channels.size();
  for (std::size_t c = 0; c < channels; ++c) {
    if (!isLightChannel(image.channels[c])) continue;
    for (std::size_t i = c; i < image.pixels.size(); i += channels)
      image.pixels[i] = std::clamp(image.pixels[i] * scale, -kLargest, kLargest);
  }
}

}  // namespace luciole
