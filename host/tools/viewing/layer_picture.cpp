#include "tools/viewing/layer_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <glm/glm.hpp>
#include <limits>
#include <utility>

#include "base/machine_memory.hpp"
#include "base/random.hpp"
#include "image/heat_map.hpp"
#include "image/srgb.hpp"

namespace luciole {
namespace {

/// Linear, of what has no colour of its own.
constexpr glm::vec3 kNotFinite{1.0f, 0.0f, 0.0f};

/// How far from 1 the length of a direction may be: halves round each component by 2⁻¹¹.
constexpr float kUnitError = 0.01f;

glm::vec3 linearOf(const glm::vec3& codes) {
  glm::vec3 linear;
  for (int c = 0; c < 3; ++c) linear[c] = float(decodeSrgb(std::clamp(double(codes[c]), 0.0, 1.0)));
  return linear;
}

/// A bright colour that a number always has: a hue and a lightness by its hash.
glm::vec3 colorOfId(float id) {
  std::uint64_t state = std::bit_cast<std::uint32_t>(id == 0.0f ? 0.0f : id);  // −0 is 0
  const auto hue = float(6 * nextUniform(state)), value = float(0.6 + 0.4 * nextUniform(state));
  glm::vec3 codes;
  for (int c = 0; c < 3; ++c) {
    const float turned = std::fmod(hue + 2.0f * float(c), 6.0f);
    codes[c] = value * (1 - 0.75f * std::clamp(std::min(turned, 4 - turned), 0.0f, 1.0f));
  }
  return linearOf(codes);
}

bool isFinite(const float* pixel, std::size_t count) {
  return std::all_of(pixel, pixel + count, [](float value) { return std::isfinite(value); });
}

/// Gives each pixel the colour color_of(its values). Returns how many aren't finite, which become
/// red.
template <class ColorOf>
std::size_t paint(const Image& layer, Image& picture, const ColorOf& color_of) {
  const std::size_t channels = layer.channels.size();
  std::size_t bad = 0;
  for (std::size_t p = 0, at = 0; at < picture.pixels.size(); ++p, at += 3) {
    const float* pixel = layer.pixels.data() + p * channels;
    const bool is_good = isFinite(pixel, channels);
    const glm::vec3 color = is_good ? color_of(pixel) : kNotFinite;
    bad += !is_good;
    for (int c = 0; c < 3; ++c) picture.pixels[at + std::size_t(c)] = color[c];
  }
  return bad;
}

glm::vec3 vectorOf(const float* pixel) { return {pixel[0], pixel[1], pixel[2]}; }

/// How vectors are painted: by their direction, or where most aren't of length 1, between bounds.
struct VectorScale {
  bool is_unit = false;
  glm::vec3 low{std::numeric_limits<float>::max()}, high{-std::numeric_limits<float>::max()};
};

VectorScale scaleOf(const Image& layer) {
  VectorScale scale;
  std::size_t unit = 0, count = 0;
  for (std::size_t at = 0; at < layer.pixels.size(); at += layer.channels.size()) {
    const glm::vec3 v = vectorOf(layer.pixels.data() + at);
    if (!isFinite(&v.x, 3) || v == glm::vec3(0.0f)) continue;
    unit += std::abs(glm::length(v) - 1) <= kUnitError;
    ++count;
    scale.low = glm::min(scale.low, v);
    scale.high = glm::max(scale.high, v);
  }
  scale.is_unit = unit >= count - count / 10;
  return scale;
}

std::size_t paintVectors(const std::string& name, const Image& layer, LayerPicture& result) {
  const VectorScale scale = scaleOf(layer);
  const auto& [is_unit, low, high] = scale;
  if (!is_unit)
    result.notes.push_back(
        fmt::format("{}: red, green and blue are x from {:.5g} to {:.5g}, y from {:.5g} to {:.5g}, z from "
                    "{:.5g} to {:.5g}",
                    name, low.x, high.x, low.y, high.y, low.z, high.z));
  const glm::vec3 span = glm::max(high - low, glm::vec3(std::numeric_limits<float>::min()));
  return paint(layer, result.image, [&](const float* pixel) {
    const glm::vec3 v = vectorOf(pixel);
    if (v == glm::vec3(0.0f)) return v;
    return linearOf(scale.is_unit ? 0.5f * v + 0.5f : (v - scale.low) / span);
  });
}

/// The first channel's values, or of several the largest.
std::vector<float> largestOf(const Image& layer) {
  const std::size_t channels = layer.channels.size();
  std::vector<float> values;
  values.reserve(layer.pixels.size() / channels);
  for (std::size_t at = 0; at < layer.pixels.size(); at += channels)
    values.push_back(*std::max_element(layer.pixels.data() + at, layer.pixels.data() + at + channels));
  return values;
}

}  // namespace

LayerPicture layerPicture(const std::string& name, LayerKind kind, const Image& layer) {
  const bool has_bar = kind == LayerKind::kValue || kind == LayerKind::kBound;
  const double pixels = double(layer.width) * layer.height;
  // Values in double precision, sorted once, and in false colours, on paper.
  requireMemory(pixels * (has_bar ? 3 * sizeof(double) + 8 * sizeof(float) : 3 * sizeof(float)),
                fmt::format("a picture of {} x {} pixels", layer.width, layer.height));
  LayerPicture result;
  if (has_bar) {
    std::vector<float> values = largestOf(layer);
    result.image = kind == LayerKind::kBound
                       ? boundMap(layer.width, layer.height, values)
                       : valueSheet(layer.width, layer.height, {{"", std::move(values)}}, 1, name);
    return result;
  }
  result.image = {layer.width, layer.height, {"R", "G", "B"}, {}, layer.picture_size, layer.crop_origin};
  result.image.pixels.resize(std::size_t(3 * pixels));
  std::size_t bad = 0;
  switch (kind) {
    case LayerKind::kVector:
      bad = paintVectors(name, layer, result);
      break;
    case LayerKind::kId:
      bad = paint(layer, result.image,
                  [](const float* pixel) { return *pixel < 0 ? glm::vec3(0.0f) : colorOfId(*pixel); });
      break;
    case LayerKind::kMatte:
      bad = paint(layer, result.image, [&](const float* pixel) {
        glm::vec3 sum(0.0f);
        for (std::size_t c = 0; c + 1 < layer.channels.size(); c += 2)
          if (pixel[c] != 0) sum += pixel[c + 1] * colorOfId(pixel[c]);
        return sum;
      });
      break;
    default:
      bad = paint(layer, result.image, [&](const float* pixel) {
        return layer.channels.size() == 3 ? vectorOf(pixel) : glm::vec3(*pixel);
      });
  }
  if (bad > 0)
    result.notes.push_back(
        fmt::format("{}: {} pixel{} not finite and shown red", name, bad, bad == 1 ? " is" : "s are"));
  return result;
}

}  // namespace luciole
