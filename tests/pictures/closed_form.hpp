#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <string>

#include "render_json.hpp"
#include "single_precision.hpp"

// A floor seen from above, and what light does to it by formulas of this file's own, with how far float may
// be off. Nothing is taken from the G-buffer or the reference.
namespace luciole::test {

inline constexpr int kSide = 32;         // pixels a side; even, so that pixels lie at binary fractions
inline constexpr double kEyeHeight = 2;  // metres above the floor

/// A floor at y = 0 that fills a square picture, seen straight from above; 90 degrees wide, or by a parallel
/// view of the same part. Its material is "m".
inline std::string floorScene(const std::string& rest, double eye_height = kEyeHeight,
                              bool parallel = false) {
  return fmt::format(
      R"({{"camera": {{"eye": [0, {0}, 0], "target": [0, 0, 0], "up": [0, 0, -1], {1}}},
      "objects": [{{"primitive": "plane", "scale": 40, "material": "m"}}], {2}}})",
      eye_height, parallel ? fmt::format("\"orthographic\": {}", eye_height) : "\"fov_y\": 90", rest);
}

inline constexpr const char* kMatte = R"("materials": {"m": {"diffuse": 0.5}})";

inline Image render(const std::string& json) {
  return renderJson(json, {kSide, kSide}, [](RenderSettings&) {});
}

/// What the middle of pixel (x, y) shows of the floor.
inline glm::dvec3 floorPoint(int x, int y, double eye_height = kEyeHeight) {
  return eye_height * glm::dvec3((x + 0.5) / (kSide / 2.0) - 1, 0, (y + 0.5) / (kSide / 2.0) - 1);
}

/// A value and how far float may be off.
struct Known {
  double value = 0, error = 0;
};

/// Every channel of every pixel is what `known(floor point)` says.
template <class Function>
void expectFloor(const Image& image, Function known, double eye_height = kEyeHeight) {
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const Known expected = known(floorPoint(x, y, eye_height));
      for (int c = 0; c < 3; ++c)
        ASSERT_NEAR(image.pixels[(y * kSide + x) * 3 + c], expected.value, expected.error)
            << "pixel " << x << "," << y << " channel " << c;
    }
  }
}

/// A point of the floor under a light with a place.
struct Lit {
  glm::dvec3 to_light;   ///< unit
  double distance = 0;   ///< metres
  double way_error = 0;  ///< of to_light, as a length
  double n_dot_l = 0;    ///< within way_error and 6 roundings: three products, two sums and the normal
};

/// In view space the point's and the light's place round (by their distances from the eye), and their
/// difference; d² rounds 3 times more, its root's reciprocal is within 3 ulp, 6 roundings, and each product
/// with it rounds: 12 in all.
inline Lit litBy(const glm::dvec3& light, const glm::dvec3& point) {
  const glm::dvec3 eye(0, kEyeHeight, 0), way = light - point;
  const double distance = glm::length(way);
  return {way / distance, distance,
          kUnit * ((glm::length(light - eye) + glm::length(point - eye)) / distance + 12), way.y / distance};
}

/// Lambert's cosine for a light of `brightness`, the product of light, material and falloff, each of which
/// may round: 6 more. `falloff_error` is relative.
inline Known lambert(double brightness, const Lit& lit, double falloff_error = 0) {
  return {brightness * lit.n_dot_l,
          brightness * (lit.way_error + 6 * kUnit + lit.n_dot_l * (6 * kUnit + falloff_error)) + 0x1p-126};
}

/// cosⁿ of a cosine that is off by `error`: the power's own error is n·log2(cos)·5 and 4 roundings, and
/// results below the normal numbers are 0 (kernels/math.clh).
inline Known power(double cosine, double error, double n) {
  const auto exact = [&](double c) { return std::pow(std::clamp(c, 0.0, 1.0), n); };
  const double value = exact(cosine);
  const double moved = std::max(exact(cosine + error) - value, value - exact(cosine - error));
  const double log2 = value > 0 ? -std::log2(std::min(cosine, 1.0)) : 0;
  return {value, moved + value * (n * log2 * 5 * kUnit + 4 * kUnit) + 0x1p-125};
}

}  // namespace luciole::test
