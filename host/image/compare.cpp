#include "luciole/compare.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "luciole/error.hpp"

namespace luciole {
namespace {

// OpenImageIO's own compare() takes infinities of both signs for equal, counts what is not finite into its
// means, and knows no bias, percentiles or sampled pixels. Tests compare the figures that both define alike.

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Added to magnitudes, and to squares, before a difference is divided by them, so that dark values don't
/// rule the means.
constexpr double kDark = 1e-2;
constexpr const char* kSampled = "sampled";

/// A channel of both pictures: its name and where it lies in a pixel of each.
struct SharedChannel {
  std::string name;
  std::size_t in_a = 0;
  std::size_t in_b = 0;
};

/// What is compared: channels, and which pixels.
struct Overlap {
  std::vector<SharedChannel> channels;
  std::vector<bool> sampled;
};

/// Where a channel lies in a pixel; the number of channels where there is none of the name.
std::size_t channelPlace(const Image& image, const std::string& name) {
  return std::size_t(std::find(image.channels.begin(), image.channels.end(), name) - image.channels.begin());
}

bool hasChannel(const Image& image, const std::string& name) {
  return channelPlace(image, name) < image.channels.size();
}

std::vector<SharedChannel> sharedChannels(const Image& a, const Image& b) {
  std::vector<SharedChannel> shared;
  for (std::size_t i = 0; i < a.channels.size(); ++i) {
    const std::string& name = a.channels[i];
    if (name != "A" && name != kSampled && hasChannel(b, name))
      shared.push_back({name, i, channelPlace(b, name)});
  }
  const auto in_one_alone = [&](const char* name) { return hasChannel(a, name) != hasChannel(b, name); };
  const auto colors = {"R", "G", "B", "Y"};
  if (shared.empty() || std::any_of(colors.begin(), colors.end(), in_one_alone)) {
    throw InputError(fmt::format("channels '{}' and '{}', expected the same colours in both",
                                 fmt::join(a.channels, " "), fmt::join(b.channels, " ")));
  }
  return shared;
}

std::vector<bool> sampledPixels(const Image& a, const Image& b) {
  std::vector<bool> sampled(std::size_t(a.width) * a.height, true);
  for (const Image* image : {&a, &b}) {
    if (!hasChannel(*image, kSampled)) continue;
    const std::size_t place = channelPlace(*image, kSampled);
    for (std::size_t p = 0; p < sampled.size(); ++p) {
      if (image->pixels[p * image->channels.size() + place] == 0) sampled[p] = false;
    }
  }
  if (std::find(sampled.begin(), sampled.end(), true) == sampled.end()) {
    throw InputError(fmt::format("channel '{}' is 0 everywhere, expected a pixel to compare", kSampled));
  }
  return sampled;
}

Overlap overlapOf(const Image& a, const Image& b) {
  if (a.width != b.width || a.height != b.height) {
    throw InputError(fmt::format("{} x {} and {} x {} pixels, expected the same size", a.width, a.height,
                                 b.width, b.height));
  }
  if (a.picture_size == b.picture_size && a.crop_origin != b.crop_origin) {
    throw InputError(fmt::format("parts of a picture that start at {},{} and {},{}, expected the same part",
                                 a.crop_origin.x, a.crop_origin.y, b.crop_origin.x, b.crop_origin.y));
  }
  return {sharedChannels(a, b), sampledPixels(a, b)};
}

/// b − a; 0 for the same value, infinite where one alone is not finite.
double signedDifference(double a, double b) {
  if (a == b || (std::isnan(a) && std::isnan(b))) return 0.0;
  if (!std::isfinite(a) || !std::isfinite(b)) return kInfinity;
  return b - a;
}

/// The smallest value that at least the share `p` of all values does not exceed. Reorders `values`, which
/// must not be empty. O(n) on average.
double percentile(std::vector<double>& values, double p) {
  const auto rank = std::size_t(std::ceil(p * double(values.size())));
  const auto place = values.begin() + std::ptrdiff_t(std::max<std::size_t>(rank, 1) - 1);
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

}  // namespace

ImageDifference compareImages(const Image& a, const Image& b) {
  const Overlap overlap = overlapOf(a, b);
  ImageDifference result;
  result.width = a.width;
  result.height = a.height;
  for (const SharedChannel& channel : overlap.channels) result.channels.push_back(channel.name);
  result.of_pixel.assign(overlap.sampled.size(), kNotCompared);
  std::vector<double> compared;
  compared.reserve(overlap.sampled.size());
  double sum = 0, sum_abs = 0, sum_squared = 0, sum_relative = 0, sum_share = 0, sum_symmetric = 0;
  double largest_value = 0;
  std::uint64_t finite = 0;
  for (std::size_t p = 0; p < overlap.sampled.size(); ++p) {
    if (!overlap.sampled[p]) continue;
    double largest = 0;
    for (const SharedChannel& channel : overlap.channels) {
      const double value = a.pixels[p * a.channels.size() + channel.in_a];
      if (std::isfinite(value)) largest_value = std::max(largest_value, std::abs(value));
      const double other = b.pixels[p * b.channels.size() + channel.in_b];
      const double d = signedDifference(value, other);
      largest = std::max(largest, std::abs(d));
      if (std::isinf(d)) {
        ++result.nonfinite;
        continue;
      }
      ++finite;
      sum += d;
      sum_abs += std::abs(d);
      sum_squared += d * d;
      if (d == 0) continue;  // also of two infinities or NaNs
      sum_relative += d * d / (value * value + kDark);
      sum_share += std::abs(d) / (std::abs(value) + kDark);
      sum_symmetric += 2 * std::abs(d) / (std::abs(value) + std::abs(other) + kDark);
    }
    result.of_pixel[p] = largest;
    compared.push_back(largest);
    for (std::size_t i = 0; i < kOverLimits.size(); ++i) result.over[i] += largest > kOverLimits[i];
    if (largest > result.max_abs || compared.size() == 1) {
      result.max_abs = largest;
      result.worst_pixel = {int(p % a.width), int(p / a.width)};
    }
  }
  if (finite == 0) sum = sum_abs = sum_squared = sum_relative = sum_share = sum_symmetric = kInfinity;
  const double count = double(std::max<std::uint64_t>(finite, 1));
  const auto relative = [&](double difference) { return difference > 0 ? difference / largest_value : 0.0; };
  result.pixels = compared.size();
  result.mean_abs = sum_abs / count;
  result.max_relative = relative(result.max_abs);
  result.mean_relative = relative(result.mean_abs);
  result.mean_signed = sum / count;
  result.mse = sum_squared / count;
  result.rmse = std::sqrt(result.mse);
  result.psnr = sum_squared > 0 ? -10.0 * std::log10(result.mse) : kInfinity;
  result.relmse = sum_relative / count;
  result.mape = sum_share / count;
  result.smape = sum_symmetric / count;
  result.p99_abs = percentile(compared, 0.99);
  result.p999_abs = percentile(compared, 0.999);
  return result;
}

Image differencePicture(const Image& a, const Image& b, float gain) {
  const Overlap overlap = overlapOf(a, b);
  Image difference{a.width, a.height, {}, {}};
  for (const SharedChannel& channel : overlap.channels) difference.channels.push_back(channel.name);
  difference.pixels.reserve(overlap.sampled.size() * overlap.channels.size());
  for (std::size_t p = 0; p < overlap.sampled.size(); ++p) {
    for (const SharedChannel& channel : overlap.channels) {
      const double d = signedDifference(a.pixels[p * a.channels.size() + channel.in_a],
                                        b.pixels[p * b.channels.size() + channel.in_b]);
      difference.pixels.push_back(overlap.sampled[p] ? float(std::abs(d) * gain) : 0.0f);
    }
  }
  return difference;
}

}  // namespace luciole
