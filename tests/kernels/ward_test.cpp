#include <fmt/format.h>
#include <gtest/gtest.h>

#include "kernels/probe.hpp"
#include "kernels/random_scene.hpp"
#include "kernels/shade_bounds.hpp"

namespace luciole::test {
namespace {

/// Float vectors, unit but for their rounding.
struct Highlights {
  std::vector<Column> in{18};
  std::vector<Directions> exact;                            ///< the same vectors, exactly unit
  std::vector<std::pair<glm::dvec3, glm::dvec3>> brushing;  ///< tangent, bitangent; likewise

  void add(const Directions& at, float shininess, glm::vec2 alpha, const glm::dvec3& aside) {
    const glm::dvec3 tangent = unitOrZero(glm::cross(at.normal, aside)),
                     bitangent = glm::cross(at.normal, tangent);
    const glm::vec3 rounded[] = {at.normal, at.to_light, at.to_eye, tangent, bitangent};
    for (int i = 0; i < 15; ++i) in[i < 9 ? i : i + 1].push_back(rounded[i / 3][i % 3]);
    in[9].push_back(shininess);
    in[16].push_back(alpha.x);
    in[17].push_back(alpha.y);
    exact.push_back({unitOrZero(rounded[0]), unitOrZero(rounded[1]), unitOrZero(rounded[2])});
    brushing.push_back({unitOrZero(rounded[3]), unitOrZero(rounded[4])});
  }

  std::vector<Column> reflected(int lanes) const {
    return probe(deviceWithLanes(lanes), "ward_probe.cl", "probe_ward", in, 2);
  }
};

/// A direction whose cosine with the normal is this.
glm::dvec3 leaningTo(const glm::dvec3& normal, double cosine, Random& random) {
  const glm::dvec3 aside = glm::normalize(glm::cross(normal, random.direction()));
  return cosine * normal + std::sqrt(1 - cosine * cosine) * aside;
}

/// From the mirror direction to anywhere, light and eye steep and grazing, some eyes behind the surface, some
/// where the light is.
Highlights highlightsOf(float shininess, Random& random) {
  Highlights highlights;
  const auto cosine = [&] { return std::exp2(-random.between(0, 20)); };
  for (int i = 0; i < 4000; ++i) {
    Directions at{.normal = random.direction()};
    at.to_light = leaningTo(at.normal, cosine(), random);
    at.to_eye = leaningTo(at.normal, random.chance(0.1) ? -cosine() : cosine(), random);
    const glm::dvec3 mirrored = 2 * glm::dot(at.normal, at.to_light) * at.normal - at.to_light;
    const glm::dvec3 near = cosine() * random.direction();
    if (random.chance(0.5)) at.to_eye = glm::normalize(mirrored + near);
    if (random.chance(0.05)) at.to_eye = glm::normalize(at.to_light + near);
    const float alpha = std::sqrt(2 / (shininess + 2));
    highlights.add(at, shininess, {alpha, std::max(alpha * float(cosine()), 0x1p-20f)}, random.direction());
  }
  return highlights;
}

void expectIn(const Interval& bounds, float kernels, double reference, const std::string& what) {
  ASSERT_TRUE(kernels >= bounds.low && kernels <= bounds.high)
      << what << ": " << kernels << " outside " << bounds.low << " … " << bounds.high;
  ASSERT_TRUE(reference >= bounds.low && reference <= bounds.high)
      << what << ": the reference's " << reference;
}

TEST(WardKernel, IsTheReferencesAtEveryWidth) {
  Random random(3);
  for (const float shininess : {0.0f, 1.0f, 32.0f, 1e4f, 1e6f}) {
    const Highlights highlights = highlightsOf(shininess, random);
    for (const int lanes : kAllLanes) {
      const std::vector<Column> out = highlights.reflected(lanes);
      for (std::size_t i = 0; i < out[0].size(); ++i) {
        const Directions& at = highlights.exact[i];
        const auto& [tangent, bitangent] = highlights.brushing[i];
        // The vectors' lengths are off by 2 roundings at most, as directions they are exact.
        const WayToLight way{.unit = at.to_light, .error = 2 * kUnit};
        const glm::dvec2 alpha{highlights.in[16][i], highlights.in[17][i]};
        const std::string what = fmt::format("{}, exponent {}, {} lanes", i, shininess, lanes);
        expectIn(wardInterval(at.normal, way, at.to_eye, shininess), out[0][i], ward(at, shininess), what);
        expectIn(wardAnisotropicInterval(at.normal, way, at.to_eye, tangent, bitangent, alpha), out[1][i],
                 wardAnisotropic(at, tangent, bitangent, alpha), what + ", brushed");
        if (HasFatalFailure()) return;
      }
    }
  }
}

TEST(WardKernel, OfEqualRoughnessesIsTheIsotropicOneForAnyTangents) {
  Random random(4);
  // α = √(2/(n + 2)) is a float.
  for (const float alpha : {1.0f, 0x1p-1f, 0x1p-3f, 0x1p-11f}) {
    const float shininess = 2 / (alpha * alpha) - 2;
    Highlights highlights = highlightsOf(shininess, random);
    highlights.in[17] = highlights.in[16] = Column(highlights.in[16].size(), alpha);
    for (const int lanes : kAllLanes) {
      const std::vector<Column> out = highlights.reflected(lanes);
      for (std::size_t i = 0; i < out[0].size(); ++i) {
        const Directions& at = highlights.exact[i];
        // The axes' own rounding turns them by 2 units.
        expectIn(wardInterval(at.normal, {.unit = at.to_light, .error = 30 * kUnit}, at.to_eye, shininess),
                 out[1][i], ward(at, shininess), fmt::format("{}, roughness {}, {} lanes", i, alpha, lanes));
        if (HasFatalFailure()) return;
      }
    }
  }
}

TEST(WardKernel, PeaksOfNarrowLobesAreNotCutOff) {
  const glm::dvec3 up{0, 0, 1}, right{1, 0, 0};
  const std::vector<float> exponents{1e8f, 1e9f, 1e11f, 1e12f};
  Highlights highlights;
  for (const float shininess : exponents)
    highlights.add({up, up, up}, shininess, glm::vec2(std::sqrt(2 / shininess)), right);
  for (const int lanes : kAllLanes)
    for (const Column& peaks : highlights.reflected(lanes))
      // Nothing rounds but the roughness and the result: T is 0.
      for (std::size_t i = 0; i < peaks.size(); ++i)
        EXPECT_NEAR(peaks[i] * 8.0 / exponents[i], 1, 8 * kUnit) << exponents[i] << ", " << lanes << " lanes";
}

TEST(WardKernel, WhatFacesAwayIsExactlyBlack) {
  Random random(4);
  Highlights highlights;
  for (int i = 0; i < 1000; ++i) {
    const glm::dvec3 normal = random.direction(), away = leaningTo(normal, -random.between(1e-6, 1), random);
    const float shininess = std::array{0.0f, 1e4f, 3e38f}[i % 3];
    highlights.add({normal, away, random.direction()}, shininess, {1, 1e-6f}, random.direction());
  }
  for (const int lanes : kAllLanes)
    for (const Column& out : highlights.reflected(lanes))
      EXPECT_EQ(out, Column(1000, 0.0f)) << lanes << " lanes";
}

TEST(WardKernel, IsFiniteAndWithinItsBoundWhereTheFormulaIsNot) {
  const glm::dvec3 up{0, 0, 1}, right{1, 0, 0}, none{0, 0, 0};
  Highlights highlights;
  for (const float shininess : {0.0f, 1e-30f, 1e4f, 1e12f, 3e38f})
    for (const glm::vec2& alpha : {glm::vec2(1), glm::vec2(1, 0), glm::vec2(0, 1e-30f)}) {
      highlights.add({up, up, -up}, shininess, alpha, right);                         // h = 0,
      highlights.add({up, {0.6, 0, 0.8}, {-0.6, 0, -0.8}}, shininess, alpha, right);  // here, too,
      highlights.add({up, {1, 0, 1e-20}, {-1, 0, 1e-20}}, shininess, alpha, right);   // and at a glance
      highlights.add({up, {1, 0, 1e-20}, {-1, 0, -1e-7}}, shininess, alpha, right);
      highlights.add({up, {1, 0, 1e-20}, right}, shininess, alpha, right);  // h·N = 0
      highlights.add({up, {1, 0, 1e-7}, {0, 1, 0}}, shininess, alpha, right);
      highlights.add({up, up, up}, shininess, alpha, right);    // the peak
      highlights.add({none, up, up}, shininess, alpha, right);  // no normal
      highlights.add({up, none, up}, shininess, alpha, right);  // at the light's own place
    }
  for (const int lanes : kAllLanes)
    for (const Column& out : highlights.reflected(lanes))
      for (const float value : out) {
        EXPECT_GE(value, 0) << lanes << " lanes";
        EXPECT_LE(value, 0x1p60f) << lanes << " lanes";  // 2^20/α²
      }
}

}  // namespace
}  // namespace luciole::test
