#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <utility>

#include "base/machine_memory.hpp"
#include "base/picture_size.hpp"
#include "luciole/error.hpp"
#include "luciole/image.hpp"
#include "luciole/light.hpp"

namespace luciole {
namespace {

constexpr float kMostSkyRadiance = 1e15f;

/// The next level: each texel is the mean of those that it covers.
SkyLevel halved(const SkyLevel& level) {
  SkyLevel half{std::max(level.width / 2, 1), std::max(level.height / 2, 1), {}};
  half.texels.resize(3 * std::size_t(half.width) * half.height);
  const auto first = [](int i, int count, int of) { return int(std::int64_t(i) * of / count); };
  tbb::parallel_for(0, half.height, [&](int y) {
    const int top = first(y, half.height, level.height), bottom = first(y + 1, half.height, level.height);
    for (int x = 0; x < half.width; ++x) {
      const int left = first(x, half.width, level.width), right = first(x + 1, half.width, level.width);
      std::array<double, 3> sum{};
      for (int v = top; v < bottom; ++v)
        for (int u = left; u < right; ++u)
          for (int c = 0; c < 3; ++c) sum[c] += level.texels[3 * (std::size_t(v) * level.width + u) + c];
      for (int c = 0; c < 3; ++c)
        half.texels[3 * (std::size_t(y) * half.width + x) + c] =
            float(sum[c] / (double(bottom - top) * (right - left)));
    }
  });
  return half;
}

/// Where a direction lies on a cross: which square, counted from the top left, and where in it, from −1 to 1
/// to the right and up.
struct CrossPlace {
  int column, row;
  double right, up;
};

CrossPlace crossPlace(const glm::dvec3& d, bool is_tall) {
  const glm::dvec3 a = glm::abs(d);
  if (a.y >= a.x && a.y >= a.z)
    return d.y > 0 ? CrossPlace{1, 0, d.x / a.y, d.z / a.y} : CrossPlace{1, 2, d.x / a.y, -d.z / a.y};
  if (a.x >= a.z)
    return d.x > 0 ? CrossPlace{2, 1, d.z / a.x, d.y / a.x} : CrossPlace{0, 1, -d.z / a.x, d.y / a.x};
  if (d.z < 0) return {1, 1, d.x / a.z, d.y / a.z};
  // Behind: at the right end of a wide cross, upside down at the foot of a tall one.
  return is_tall ? CrossPlace{1, 3, d.x / a.z, -d.y / a.z} : CrossPlace{3, 1, -d.x / a.z, d.y / a.z};
}

/// A cross of a cube's faces by latitude and longitude, with as many texels around the horizon.
std::vector<float> unfolded(const Image& cross, int channels, bool is_tall, int side) {
  const int width = 4 * side, height = 2 * side;
  std::vector<float> texels(3 * std::size_t(width) * height);
  tbb::parallel_for(0, height, [&](int y) {
    const double theta = glm::pi<double>() * (y + 0.5) / height;
    for (int x = 0; x < width; ++x) {
      const double phi = 2 * glm::pi<double>() * ((x + 0.5) / width - 0.5);
      const CrossPlace place = crossPlace(
          {std::sin(theta) * std::sin(phi), std::cos(theta), -std::sin(theta) * std::cos(phi)}, is_tall);
      // Bilinear within the face.
      const auto texel = [&](double v) { return std::clamp((v + 1) / 2 * side - 0.5, 0.0, side - 1.0); };
      const double u = texel(place.right), v = texel(-place.up);
      const int u0 = int(u), v0 = int(v), u1 = std::min(u0 + 1, side - 1), v1 = std::min(v0 + 1, side - 1);
      const auto at = [&](int column, int row, int c) {
        const std::size_t pixel =
            std::size_t(place.row * side + row) * cross.width + place.column * side + column;
        return double(cross.pixels[pixel * cross.channels.size() + (channels < 3 ? 0 : c)]);
      };
      for (int c = 0; c < 3; ++c)
        texels[3 * (std::size_t(y) * width + x) + c] =
            float(std::lerp(std::lerp(at(u0, v0, c), at(u1, v0, c), u - u0),
                            std::lerp(at(u0, v1, c), at(u1, v1, c), u - u0), v - v0));
    }
  });
  return texels;
}

}  // namespace

std::shared_ptr<const Sky> makeSky(int width, int height, std::span<const float> texels,
                                   const std::string& name, std::vector<Warning>& warnings) {
  if (width < 2 || width > kLargestSide || width != 2 * height)
    throw InputError(fmt::format("{}: a sky of {}x{}; expected twice as wide as high, 2 to {} wide", name,
                                 width, height, kLargestSide));
  if (texels.size() != 3 * std::size_t(width) * height)
    throw InputError(fmt::format("{}: {} numbers, expected 3 x {} x {}", name, texels.size(), width, height));
  requireMemory(double(texels.size()) * sizeof(float) * 4 / 3, name);
  auto sky = std::make_shared<Sky>();
  sky->name = name;
  sky->levels.push_back({width, height, RawArray<float>(texels.begin(), texels.end())});
  std::size_t wrong = 0, bright = 0;
  for (float& value : sky->levels[0].texels) {
    const bool is_light = value >= 0 && std::isfinite(value);
    wrong += !is_light;
    bright += is_light && value > kMostSkyRadiance;
    value = is_light ? std::min(value, kMostSkyRadiance) : 0.0f;
  }
  if (wrong > 0)
    warnings.push_back({fmt::format("{}: {} numbers that are negative or not finite count as 0", name, wrong),
                        "sky's numbers", true});
  if (bright > 0)
    warnings.push_back(
        {fmt::format("{}: {} numbers above 1e15 count as that", name, bright), "sky's large numbers", true});
  while (sky->levels.back().height > 1) sky->levels.push_back(halved(sky->levels.back()));
  return sky;
}

std::shared_ptr<const Sky> readSky(const std::string& path, std::vector<Warning>& warnings) {
  const Image image = readImage(path);
  const int channels = int(image.channels.size()), width = image.width, height = image.height;
  const bool is_wide = 3 * width == 4 * height, is_tall = 4 * width == 3 * height;
  if (!is_wide && !is_tall && width != 2 * height)
    throw InputError(
        fmt::format("{}: a picture of {}x{} as a sky; expected latitude and longitude, twice as "
                    "wide as high, or a cross of a cube's faces, 4:3 or 3:4",
                    path, width, height));
  if (channels < 3 && channels != 1)
    throw InputError(fmt::format("{}: {} channels as a sky, expected 1, or 3 or more", path, channels));
  if (is_wide || is_tall) {
    const int side = is_wide ? width / 4 : width / 3;
    if (4 * side > kLargestSide)
      throw InputError(
          fmt::format("{}: faces of {} texels a side, expected {} at most", path, side, kLargestSide / 4));
    return makeSky(4 * side, 2 * side, unfolded(image, channels, is_tall, side), path, warnings);
  }
  std::vector<float> texels(3 * std::size_t(width) * height);
  for (std::size_t i = 0; i < texels.size(); ++i)
    texels[i] = image.pixels[i / 3 * channels + (channels < 3 ? 0 : i % 3)];
  return makeSky(width, height, texels, path, warnings);
}

}  // namespace luciole
