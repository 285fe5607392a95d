#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>

#include "kernels/probe.hpp"
#include "kernels/shared.h"
#include "single_precision.hpp"

namespace luciole::test {
namespace {

/// distance_falloff and spot_falloff of one light for each vector to it.
std::vector<Column> falloffs(int lanes, const ShadeLight& light, const std::vector<Column>& to_light,
                             const std::string& defines = "") {
  return probe(deviceWithLanes(lanes), "falloff_probe.cl", "probe_falloff", to_light, 2, {{"light", light}},
               defines);
}

/// Vectors of these lengths along no axis: (2, 3, 6)/7.
std::vector<Column> vectorsOfLength(const Column& lengths) {
  std::vector<Column> columns(3);
  for (const float length : lengths)
    for (int c = 0; c < 3; ++c) columns[c].push_back(length * std::array{2.0f, 3.0f, 6.0f}[c] / 7.0f);
  return columns;
}

double lengthOf(const std::vector<Column>& columns, std::size_t i) {
  return std::sqrt(double(columns[0][i]) * columns[0][i] + double(columns[1][i]) * columns[1][i] +
                   double(columns[2][i]) * columns[2][i]);
}

Column steps(float low, float high, int count) {
  Column values;
  for (int i = 0; i <= count; ++i) values.push_back(low + (high - low) * float(i) / float(count));
  return values;
}

struct WindowCase {
  const char* defines;
  bool khr;
};

// ρ = d²/r² has 3 roundings of d², 1/r²'s own and one of the product: 5. 1 − ρ² is off by 2·5 + 2, its square
// by twice that.
constexpr double kWindowError = 25 * kUnit;

TEST(FalloffKernels, RangeWindowsEndExactlyAtZero) {
  ShadeLight light{};
  light.attenuation = {1, 0, 0, 0};
  const float range = 7.5f;
  light.position.w = 1.0f / (range * range);
  const auto to_light = vectorsOfLength(steps(0, 2 * range, 4000));
  for (const WindowCase window : {WindowCase{"", false},
                                  {"", true},
                                  {"-DFEATURES=ALL_FEATURES-FEATURE(KHR_WINDOW)", false},
                                  {"-DFEATURES=ALL_FEATURES-FEATURE(SMOOTH_WINDOW)", true}}) {
    light.khr_window = window.khr;
    for (const int lanes : lanesFor(window.defines)) {
      const Column strength = falloffs(lanes, light, to_light, window.defines)[0];
      for (std::size_t i = 0; i < strength.size(); ++i) {
        const double ratio = lengthOf(to_light, i) / range;
        const double fade = std::max(1 - std::pow(ratio, 4), 0.0);
        ASSERT_NEAR(strength[i], window.khr ? fade : fade * fade, kWindowError)
            << ratio << ", " << lanes << " lanes";
        ASSERT_GE(strength[i], 0);
        if (ratio > 1 + 5 * kUnit) {
          ASSERT_EQ(strength[i], 0) << ratio << ", " << lanes << " lanes";
        }
      }
    }
  }
}

TEST(FalloffKernels, WithoutARangeNothingFades) {
  ShadeLight light{};
  light.attenuation = {1, 0, 0, 0};
  const auto to_light = vectorsOfLength({0, 1e-18f, 1e-3f, 1, 1e6f, 1e18f});
  for (const int lanes : {1, 16})
    for (const char* defines :
         {"", "-DFEATURES=ALL_FEATURES-FEATURE(KHR_WINDOW)-FEATURE(ATTENUATION)",
          "-DFEATURES=ALL_FEATURES-FEATURE(SMOOTH_WINDOW)-FEATURE(KHR_WINDOW)-FEATURE(ATTENUATION)"})
      EXPECT_EQ(falloffs(lanes, light, to_light, defines)[0], Column(6, 1.0f))
          << lanes << " lanes " << defines;
}

TEST(FalloffKernels, AttenuationIsOpenGLs) {
  const auto to_light = vectorsOfLength(steps(0.001f, 50, 2000));
  for (const float4 k : {float4{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0.5f, 2, 0.125f, 0}}) {
    ShadeLight light{};
    light.attenuation = k;
    for (const int lanes : kAllLanes) {
      const Column strength = falloffs(lanes, light, to_light)[0];
      for (std::size_t i = 0; i < strength.size(); ++i) {
        const double d = lengthOf(to_light, i);
        const double exact = 1 / (k.x + k.y * d + k.z * d * d);
        // A sum of positive terms: the worst of them, d²·(1/d), has 3 + 1 + 6 roundings; the sum 4 more, and
        // OpenCL allows 2.5 ulp, 5 roundings, to a division.
        ASSERT_NEAR(strength[i], exact, 20 * kUnit * exact) << d << ", " << lanes << " lanes";
      }
    }
  }
}

TEST(FalloffKernels, AttenuationIsCappedAtTheLightItself) {
  for (const float4 k : {float4{0, 1, 0, 0}, {0, 0, 1, 0}}) {
    ShadeLight light{};
    light.attenuation = k;
    for (const int lanes : kAllLanes)
      // 2^100, but for the 2.5 ulp that OpenCL allows to a division.
      EXPECT_NEAR(falloffs(lanes, light, vectorsOfLength({0}))[0][0], 0x1p100, 3 * 0x1p77)
          << lanes << " lanes";
  }
}

/// A spot that shines along −z, and vectors to it at these angles to its axis, up to π.
struct SpotCase {
  ShadeLight light{};
  double cutoff = 0, inner = 0;  // radians

  static SpotCase exponent(double degrees, float exponent) {
    SpotCase spot;
    spot.cutoff = glm::radians(degrees);
    spot.light.direction = {0, 0, -1, float(std::cos(spot.cutoff))};
    spot.light.diffuse.w = exponent;
    return spot;
  }
  static SpotCase cone(double inner_degrees, double degrees) {
    SpotCase spot = exponent(degrees, 0);
    spot.inner = glm::radians(inner_degrees);
    spot.light.cone = 1;
    spot.light.specular.w = float(1 / (std::cos(spot.inner) - std::cos(spot.cutoff)));
    return spot;
  }
  double strength(double cosine) const {
    const double edge = std::cos(cutoff);
    if (cosine < edge) return 0;
    if (!light.cone) return std::pow(std::clamp(cosine, 0.0, 1.0), double(light.diffuse.w));
    const double ramp = std::clamp((cosine - edge) / (std::cos(inner) - edge), 0.0, 1.0);
    return ramp * ramp;
  }
};

void expectSpot(const SpotCase& spot, const std::string& defines) {
  std::vector<Column> to_light(3);
  const auto addAngle = [&](double angle) {
    to_light[0].push_back(float(2 * std::sin(angle)));
    to_light[1].push_back(0);
    to_light[2].push_back(float(2 * std::cos(angle)));
  };
  for (int i = 0; i <= 3000; ++i) addAngle(3.14159265358979 * i / 3000);
  for (double off = 1e-6; off < 0.01; off *= 1.1) {
    addAngle(spot.cutoff - off);
    addAngle(spot.cutoff + off);
  }
  for (const int lanes : lanesFor(defines)) {
    const Column strength = falloffs(lanes, spot.light, to_light, defines)[1];
    for (std::size_t i = 0; i < strength.size(); ++i) {
      const double cosine = to_light[2][i] / lengthOf(to_light, i);
      // The cosine has 3 roundings of a product along the axis, 4.5 of 1/d (see MathKernels.UnitVectors), one
      // of their product and 1 − cosine's; the edge its own; the ramp's scale one more, which at the inner
      // end moves the cosine by less than one. The strength is monotone in the cosine.
      constexpr double kCosineError = 12 * kUnit;
      const double least = spot.strength(cosine - kCosineError), most = spot.strength(cosine + kCosineError);
      const double exponent = spot.light.diffuse.w * std::abs(std::log2(std::max(cosine, 1e-9)));
      const double slack = most * (8 * kUnit + exponent * 5 * kUnit) + 0x1p-125;
      ASSERT_GE(strength[i], least - slack) << "cosine " << cosine << ", " << lanes << " lanes";
      ASSERT_LE(strength[i], most + slack) << "cosine " << cosine << ", " << lanes << " lanes";
    }
  }
}

TEST(FalloffKernels, SpotExponent) {
  for (const char* defines : {"", "-DFEATURES=ALL_FEATURES-FEATURE(SPOT_CONE)"})
    for (const double cutoff : {1.0, 30.0, 90.0})
      for (const float exponent : {0.0f, 1.0f, 8.0f, 128.0f})
        expectSpot(SpotCase::exponent(cutoff, exponent), defines);
}

TEST(FalloffKernels, SpotCone) {
  for (const char* defines : {"", "-DFEATURES=ALL_FEATURES-FEATURE(SPOT_EXPONENT)"}) {
    expectSpot(SpotCase::cone(0, 45), defines);
    expectSpot(SpotCase::cone(20, 21), defines);
    expectSpot(SpotCase::cone(80, 90), defines);
  }
}

TEST(FalloffKernels, PlainSpotIsOneInsideItsCutoff) {
  expectSpot(SpotCase::exponent(25, 0), "-DFEATURES=ALL_FEATURES-FEATURE(SPOT_CONE)-FEATURE(SPOT_EXPONENT)");
}

TEST(FalloffKernels, CutoffItselfIsInside) {
  ShadeLight light{};
  // A half space: 0 is a cosine that doesn't round.
  light.direction = {0, 0, -1, 0};
  const std::vector<Column> across{{2, 0, 1}, {0, -3, 1}, {0, 0, 0}};
  for (const int lanes : kAllLanes)
    EXPECT_EQ(falloffs(lanes, light, across,
                       "-DFEATURES=ALL_FEATURES-FEATURE(SPOT_CONE)-FEATURE(SPOT_EXPONENT)")[1],
              Column(3, 1.0f))
        << lanes << " lanes";
}

}  // namespace
}  // namespace luciole::test
