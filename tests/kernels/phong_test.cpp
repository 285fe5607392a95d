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

// What is raised to a power is 1 − x. In units of 2^-24, unit float vectors are off by 1 in length, and L
// by 5.2 in all once it is scaled (see MathKernels.UnitVectors).
//   Phong: x = |a − b|²/2 with a = L, b = V′ = 2(V·N)N − V. V·N has 3 roundings, which count twice, and N's
//   length, which counts twice in it and again in its product with N; two products and a difference round (2
//   + 1); V's length: 5.2 + 6 + 4 + 3 + 1 < 20. An error δ of a − b changes x by √(2x)·δ + δ²/2 at most; its
//   components' own roundings (2 in a square), the squares' and the sums' (3) are relative to x. Blinn: x =
//   |w|²/(|w|² + c²) with h = L + V, c = N·h and w = h − c N, so x = sin². Across N, w has L's error, V's
//   length and the sum's rounding, 5.2 + 1 + 2 < 10, over |h| ≥ ½: δ < 20, by which x changes by 2√x·δ + δ².
//   Along N it has c's error: N·L and N·V with 3 + 1 roundings each, the lengths of N, L and V, N's again in
//   its product with c, and the sum's: < 20, over |h| < 40. It adds its square to x, and doubled it is
//   relative to x by way of c². The square's roundings (5), the sum's (1) and the quotient's (5 as OpenCL has
//   it) are relative to x.
// The power's own error is |log2|·5.6 + 3.
Worst worstError(const Lobes& lobes, const Column& result, bool blinn) {
  constexpr double kDelta = 20 * kUnit, kAlong = 40 * kUnit;
  Worst worst;
  for (std::size_t i = 0; i < result.size(); ++i) {
    const glm::dvec3 n = lobes.normal[i], l = lobes.to_light[i], v = lobes.to_eye[i];
    const double exponent = lobes.in[9][i] * (blinn ? 0.5 : 1.0);
    double x = 0, moved = 0;
    if (blinn) {
      const double cosine = std::max(glm::dot(n, glm::normalize(l + v)), 0.0);
      x = 1 - cosine * cosine;
      moved = 2 * std::sqrt(std::max(x, 0.0)) * kDelta + kDelta * kDelta + kAlong * kAlong +
              (2 * kAlong + 11 * kUnit) * x;
    } else {
      x = std::max(1 - glm::dot(2 * glm::dot(n, l) * n - l, v), 0.0);
      moved = std::sqrt(2 * x) * kDelta + kDelta * kDelta + 5 * kUnit * x;
    }
    const auto power = [&](double y) { return std::pow(std::clamp(1 - y, 0.0, 1.0), exponent); };
    const double exact = power(x);
    const double log2 = x < 1 ? -std::log2(std::min(1 - x, 1.0)) : 0.0;
    const double bound = std::max(power(x - moved) - exact, exact - power(x + moved)) +
                         exact * (exponent * log2 * 5.6 * kUnit + 3 * kUnit) + 0x1p-125;
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
        // n·√(2x)·δ·(1 − x)ⁿ peaks at nx = ½ with √(n/e)·δ: 7.3e-4 for n = 10⁶ and δ = 20 · 2^-24. So does
        // n/2·2√x·δ·(1 − x)^(n/2).
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
      // x is at most (2^-23)² here: n·x < 2e-8.
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
