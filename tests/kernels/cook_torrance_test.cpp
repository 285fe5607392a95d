#include <gtest/gtest.h>

#include "kernels/probe.hpp"
#include "kernels/random_scene.hpp"
#include "kernels/shade_bounds.hpp"

namespace luciole::test {
namespace {

/// Float vectors, unit but for their rounding.
struct Glints {
  std::vector<Column> in{11};
  std::vector<Directions> exact;  ///< the same vectors, exactly unit

  void add(const Directions& at, float shininess, float f0) {
    const glm::vec3 rounded[] = {at.normal, at.to_light, at.to_eye};
    for (int i = 0; i < 9; ++i) in[i].push_back(rounded[i / 3][i % 3]);
    in[9].push_back(shininess);
    in[10].push_back(f0);
    exact.push_back({glm::normalize(glm::dvec3(rounded[0])), glm::normalize(glm::dvec3(rounded[1])),
                     glm::normalize(glm::dvec3(rounded[2]))});
  }

  Column reflected(int lanes) const {
    return probe(deviceWithLanes(lanes), "cook_torrance_probe.cl", "probe_cook_torrance", in, 1)[0];
  }
};

/// A direction whose cosine with the normal is this.
glm::dvec3 leaning(const glm::dvec3& normal, double cosine, Random& random) {
  const glm::dvec3 aside = glm::normalize(glm::cross(normal, random.direction()));
  return cosine * normal + std::sqrt(1 - cosine * cosine) * aside;
}

/// From the mirror direction to anywhere, light and eye steep and grazing.
Glints glintsOf(float shininess, Random& random) {
  Glints glints;
  for (int i = 0; i < 4000; ++i) {
    Directions at{.normal = random.direction()};
    at.to_light = leaning(at.normal, std::exp2(-random.between(0, 20)), random);
    at.to_eye = leaning(at.normal, std::exp2(-random.between(0, 20)), random);
    const glm::dvec3 mirrored = 2 * glm::dot(at.normal, at.to_light) * at.normal - at.to_light;
    if (random.chance(0.5))
      at.to_eye = glm::normalize(mirrored + std::exp2(-random.between(0, 20)) * random.direction());
    glints.add(at, shininess, std::array{0.0f, 0.004f, 0.04f, 0.9f, 1.0f}[random.below(5)]);
  }
  return glints;
}

TEST(CookTorranceKernel, IsTheReferencesAtEveryWidth) {
  Random random(3);
  for (const float shininess : {0.0f, 1.0f, 32.0f, 1e4f, 1e6f}) {
    const Glints glints = glintsOf(shininess, random);
    for (const int lanes : kAllLanes) {
      const Column out = glints.reflected(lanes);
      for (std::size_t i = 0; i < out.size(); ++i) {
        const auto& [normal, to_light, to_eye] = glints.exact[i];
        const double f0 = glints.in[10][i];
        // The vectors' lengths are off by 2 roundings at most, as directions they are exact.
        const Interval bounds =
            cookTorranceInterval(normal, {.unit = to_light, .error = 2 * kUnit}, to_eye, shininess, f0);
        ASSERT_TRUE(out[i] >= bounds.low && out[i] <= bounds.high)
            << i << ", exponent " << shininess << ", " << lanes << " lanes: " << out[i] << " outside "
            << bounds.low << " … " << bounds.high;
        const double exact = cookTorrance({normal, to_light, to_eye}, f0, shininess);
        ASSERT_TRUE(exact >= bounds.low && exact <= bounds.high) << i << ": the reference's " << exact;
      }
    }
  }
}

TEST(CookTorranceKernel, PeaksOfNarrowLobesAreNotCutOff) {
  const glm::dvec3 up{0, 0, 1};
  const std::vector<float> exponents{1e8f, 1e9f, 1e10f, 1e11f};
  Glints glints;
  for (const float shininess : exponents) glints.add({up, up, up}, shininess, 1);
  for (const int lanes : kAllLanes) {
    const Column peaks = glints.reflected(lanes);
    for (std::size_t i = 0; i < peaks.size(); ++i) {
      // The half vector's length is off by 3 roundings, so it lies 3·2⁻²⁴ from the normal: the square of that
      // is 0.16 % of the least α², 2·10⁻¹¹, and the peak goes by the square of their sum.
      const double peak = (exponents[i] + 2.0) / 8;
      EXPECT_NEAR(peaks[i] / peak, 1, 0.004) << "exponent " << exponents[i] << ", " << lanes << " lanes";
    }
  }
}

TEST(CookTorranceKernel, BlackAndWhatFacesAwayIsExactlyBlack) {
  Random random(4);
  Glints glints;
  for (int i = 0; i < 1000; ++i) {
    const glm::dvec3 normal = random.direction(), away = leaning(normal, -random.between(1e-6, 1), random);
    const float shininess = std::array{0.0f, 1e4f, 3e38f}[i % 3];
    glints.add({normal, away, random.direction()}, shininess, 0.5f);
    glints.add({normal, -away, random.direction()}, shininess, 0);
  }
  for (const int lanes : kAllLanes)
    EXPECT_EQ(glints.reflected(lanes), Column(2000, 0.0f)) << lanes << " lanes";
}

TEST(CookTorranceKernel, IsFiniteWhereTheFormulaIsNot) {
  const glm::dvec3 up{0, 0, 1}, right{1, 0, 0}, none{0, 0, 0};
  Glints glints;
  for (const float shininess : {0.0f, 1e-30f, 1e4f, 1e12f, 3e38f}) {
    glints.add({up, up, -up}, shininess, 1);                         // H is nowhere,
    glints.add({up, {0.6, 0, 0.8}, {-0.6, 0, -0.8}}, shininess, 1);  // nor here,
    glints.add({up, {1, 0, 1e-20}, {-1, 0, 1e-20}}, shininess, 1);   // nor at a glance
    glints.add({up, {1, 0, 1e-20}, right}, shininess, 1);            // N·V = 0
    glints.add({up, up, up}, shininess, 1);                          // the peak
    glints.add({none, up, up}, shininess, 1);                        // no normal
    glints.add({up, none, up}, shininess, 1);                        // at the light's own place
  }
  for (const int lanes : kAllLanes)
    for (const float value : glints.reflected(lanes)) {
      EXPECT_TRUE(std::isfinite(value)) << lanes << " lanes";
      EXPECT_GE(value, 0) << lanes << " lanes";
    }
}

}  // namespace
}  // namespace luciole::test
