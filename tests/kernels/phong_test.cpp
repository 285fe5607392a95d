#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <random>

#include "kernels/probe.hpp"
#include "single_precision.hpp"

namespace luciole::test {
namespace {

/// Cases for one exponent: float vectors, unit but for the one to the light, the eye near enough to the
/// mirror direction to see the lobe.
struct Lobes {
  std::vector<Column> in{10};
  std::vector<glm::dvec3> normal, to_light, to_eye;  // the same vectors, exactly unit

  void add(const glm::dvec3& n, const glm::dvec3& l, const glm::dvec3& v, float exponent,
           double distance = 1) {
    const glm::vec3 rounded[3] = {glm::vec3(n), glm::vec3(distance * l), glm::vec3(v)};
    for (int i = 0; i < 9; ++i) in[i].push_back(rounded[i / 3][i % 3]);
    in[9].push_back(exponent);
    normal.push_back(glm::normalize(glm::dvec3(rounded[0])));
    to_light.push_back(glm::normalize(glm::dvec3(rounded[1])));
    to_eye.push_back(glm::normalize(glm::dvec3(rounded[2])));
  }
};

Lobes lobesAround(float exponent, bool blinn, std::mt19937& random) {
  std::normal_distribution<double> bell;
  std::uniform_real_distribution<double> share(0, 1);
  const auto direction = [&] { return glm::normalize(glm::dvec3(bell(random), bell(random), bell(random))); };
  // cosⁿ has fallen to exp(−8) at an angle of √(16/n); Blinn's half angle is half of that.
  const double widest = std::min(1.5, std::sqrt(16.0 / std::max(exponent, 1.0f))) * (blinn ? 2 : 1);
  Lobes lobes;
  while (lobes.normal.size() < 4000) {
    const glm::dvec3 n = direction(), l = direction();
    if (glm::dot(n, l) < 0.05) continue;
    const glm::dvec3 mirrored = 2 * glm::dot(n, l) * n - l;
    const glm::dvec3 aside = glm::normalize(glm::cross(mirrored, direction()));
    const double angle = widest * share(random);
    const glm::dvec3 v = std::cos(angle) * mirrored + std::sin(angle) * aside;
    if (glm::length(l + v) < 0.5) continue;
    lobes.add(n, l, v, exponent, std::exp2(20 * share(random) - 10));
  }
  return lobes;
}

/// Largest error of a lobe as a share of its bound, and relative to the lobe's peak of 1.
struct Worst {
  double of_bound = 0, of_peak = 0;
};

// The kernel's argument is t = |a − b|²/2 for the cosine 1 − t. An error δ of the vector a − b changes t by
// √(2t)·δ + δ²/2 at most; its components' own roundings (2 in a square), the squares' and the sums' (3) are
// relative to t. In units of 2^-24, unit float vectors are off by 1 in length, and L by 5.2 in all once it is
// scaled (see MathKernels.UnitVectors):
//   Phong: a = L, b = V′ = 2(V·N)N − V. V·N has 3 roundings, which count twice, and N's length, which counts
//   twice in it and again in its product with N; two products and a difference round (2 + 1); V's length:
//   5.2 + 6 + 4 + 3 + 1 < 20.
//   Blinn: a = N, b = (L + V)/|L + V|. L's and V's errors tilt the sum by 6.2/|L + V| ≤ 12.4, it rounds (1)
//   and is scaled (5.2), N has 1: < 20.
// The power's own error is n·|log2(1 − t)|·4.2 + 3.
Worst worstError(const Lobes& lobes, const Column& result, bool blinn) {
  constexpr double kDelta = 20 * kUnit;
  Worst worst;
  for (std::size_t i = 0; i < result.size(); ++i) {
    const glm::dvec3 n = lobes.normal[i], l = lobes.to_light[i], v = lobes.to_eye[i];
    const double cosine =
        blinn ? glm::dot(n, glm::normalize(l + v)) : glm::dot(2 * glm::dot(n, l) * n - l, v);
    const double exponent = lobes.in[9][i];
    const auto power = [&](double c) { return std::pow(std::clamp(c, 0.0, 1.0), exponent); };
    const double exact = power(cosine), t = std::max(1 - cosine, 0.0);
    const double moved = std::sqrt(2 * t) * kDelta + kDelta * kDelta + 5 * kUnit * t;
    const double log2 = cosine > 0 ? -std::log2(std::min(cosine, 1.0)) : 0.0;
    const double bound = std::max(power(cosine + moved) - exact, exact - power(cosine - moved)) +
                         exact * (exponent * log2 * 5 * kUnit + 3 * kUnit) + 0x1p-125;
    const double error = std::abs(result[i] - exact);
    worst.of_bound = std::max(worst.of_bound, error / bound);
    worst.of_peak = std::max(worst.of_peak, error);
  }
  return worst;
}

TEST(PhongKernels, LobesKeepTheirShapeUpToLargeExponents) {
  std::mt19937 random(7);
  for (const float exponent : {0.0f, 1.0f, 32.0f, 1e4f, 1e6f}) {
    for (const bool blinn : {false, true}) {
      const Lobes lobes = lobesAround(exponent, blinn, random);
      for (const int lanes : kAllLanes) {
        const auto out = probe(deviceWithLanes(lanes), "phong_probe.cl", "probe_lobes", lobes.in, 2);
        const Worst worst = worstError(lobes, out[blinn], blinn);
        EXPECT_LE(worst.of_bound, 1) << exponent << (blinn ? " Blinn " : " Phong ") << lanes << " lanes";
        // n·√(2t)·δ·(1 − t)ⁿ peaks at nt = ½ with √(n/e)·δ: 7.3e-4 for n = 10⁶ and δ = 20 · 2^-24.
        EXPECT_LE(worst.of_peak, 1e-3) << exponent << (blinn ? " Blinn " : " Phong ") << lanes << " lanes";
      }
    }
  }
}

TEST(PhongKernels, MirrorDirectionIsThePeak) {
  // Axes and a 3-4-5 triangle: nothing rounds but 0.6 and 0.8 themselves.
  Lobes lobes;
  for (const float exponent : {0.0f, 1.0f, 32.0f, 1e4f, 1e6f}) {
    lobes.add({0, 0, 1}, {0, 0, 1}, {0, 0, 1}, exponent);
    lobes.add({0, 1, 0}, {0.6, 0.8, 0}, {-0.6, 0.8, 0}, exponent);
  }
  for (const int lanes : kAllLanes)
    for (const Column& lobe : probe(deviceWithLanes(lanes), "phong_probe.cl", "probe_lobes", lobes.in, 2))
      // t is at most (2^-23)²/2 here: n·t < 1e-8.
      for (const float value : lobe) EXPECT_NEAR(value, 1, 2e-7) << lanes << " lanes";
}

TEST(PhongKernels, ZeroToTheZeroIsOne) {
  Lobes lobes;
  lobes.add({0, 0, 1}, {0.6, 0, 0.8}, {0.6, 0, 0.8}, 0);  // R·V = 0.28
  lobes.add({0, 0, 1}, {0.8, 0, 0.6}, {0.8, 0, 0.6}, 0);  // R·V < 0
  lobes.add({0, 0, 1}, {0.8, 0, 0.6}, {0.8, 0, 0.6}, 1);
  for (const int lanes : kAllLanes) {
    const auto out = probe(deviceWithLanes(lanes), "phong_probe.cl", "probe_lobes", lobes.in, 2);
    EXPECT_EQ(out[0], (Column{1, 1, 0})) << lanes << " lanes";
  }
}

}  // namespace
}  // namespace luciole::test
