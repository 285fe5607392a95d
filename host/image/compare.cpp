#include "image/compare.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "error.hpp"

namespace luciole {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A channel of both pictures: its name and where it lies in a pixel of each.
struct SharedChannel {
  std::string name;
  std::size_t in_a = 0;
  std::size_t in_b = 0;
};

std::vector<SharedChannel> sharedChannels(const Image& a, const Image& b) {
  if (a.width != b.width || a.height != b.height) {
    throw InputError(fmt::format("pictures of {} x {} and {} x {} pixels, expected the same size", a.width,
                                 a.height, b.width, b.height));
  }
  std::vector<SharedChannel> shared;
  for (std::size_t i = 0; i < a.channels.size(); ++i) {
    const auto found = std::find(b.channels.begin(), b.channels.end(), a.channels[i]);
    if (found == b.channels.end() || a.channels[i] == "A") continue;
    shared.push_back({a.channels[i], i, std::size_t(found - b.channels.begin())});
  }
  if (shared.empty()) {
    const auto list = [](const Image& image) { return fmt::format("{}", fmt::join(image.channels, " ")); };
    throw InputError(
        fmt::format("pictures of channels '{}' and '{}', expected some in common", list(a), list(b)));
  }
  return shared;
}

/// b − a; 0 for the same value, infinite where one alone is not finite.
double signedDifference(float a, float b) {
  if (a == b || (std::isnan(a) && std::isnan(b))) return 0.0;
  if (!std::isfinite(a) || !std::isfinite(b)) return kInfinity;
  return double(b) - double(a);
}

/// The smallest value that at least the share `p` of all values does not exceed. Reorders them; there is one
/// at least.
double percentile(std::vector<double>& values, double p) {
  const auto rank = std::size_t(std::ceil(p * double(values.size())));
  const auto place = values.begin() + std::ptrdiff_t(std::max<std::size_t>(rank, 1) - 1);
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

}  // namespace

ImageDifference compareImages(const Image& a, const Image& b) {
  const std::vector<SharedChannel> channels = sharedChannels(a, b);
  const std::size_t pixels = std::size_t(a.width) * a.height;
  ImageDifference result;
  double sum = 0, sum_abs = 0, sum_squared = 0, sum_relative = 0;
  std::uint64_t finite = 0;
  std::vector<double> of_pixel(pixels);
  for (std::size_t p = 0; p < pixels; ++p) {
    double largest = 0;
    for (const SharedChannel& channel : channels) {
      const float value = a.pixels[p * a.channels.size() + channel.in_a];
      const double d = signedDifference(value, b.pixels[p * b.channels.size() + channel.in_b]);
      largest = std::max(largest, std::abs(d));
      if (std::isinf(d)) {
        ++result.nonfinite;
        continue;
      }
      ++finite;
      sum += d;
      sum_abs += std::abs(d);
      sum_squared += d * d;
      if (d != 0) sum_relative += d * d / (double(value) * value + 1e-2);
    }
    of_pixel[p] = largest;
    for (std::size_t i = 0; i < kOverLimits.size(); ++i) result.over[i] += largest > kOverLimits[i];
    if (largest > result.max_abs) {
      result.max_abs = largest;
      result.worst_pixel = {int(p % a.width), int(p / a.width)};
    }
  }
  const double count = double(std::max<std::uint64_t>(finite, 1));
  result.mean_abs = sum_abs / count;
  result.mean_signed = sum / count;
  result.rmse = std::sqrt(sum_squared / count);
  result.psnr = sum_squared > 0 ? -10.0 * std::log10(sum_squared / count) : kInfinity;
  result.relmse = sum_relative / count;
  if (pixels > 0) {
    result.p99_abs = percentile(of_pixel, 0.99);
    result.p999_abs = percentile(of_pixel, 0.999);
  }
  return result;
}

Image differencePicture(const Image& a, const Image& b, float gain) {
  const std::vector<SharedChannel> channels = sharedChannels(a, b);
  Image difference;
  difference.width = a.width;
  difference.height = a.height;
  for (const SharedChannel& channel : channels) difference.channels.push_back(channel.name);
  const std::size_t pixels = std::size_t(a.width) * a.height;
  difference.pixels.reserve(pixels * channels.size());
  for (std::size_t p = 0; p < pixels; ++p) {
    for (const SharedChannel& channel : channels) {
      const double d = signedDifference(a.pixels[p * a.channels.size() + channel.in_a],
                                        b.pixels[p * b.channels.size() + channel.in_b]);
      difference.pixels.push_back(float(std::abs(d) * gain));
    }
  }
  return difference;
}

}  // namespace luciole
