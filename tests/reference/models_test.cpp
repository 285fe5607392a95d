#include "reference/models.hpp"
#include "scene/models.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace luciole::test {
namespace {

const glm::dvec3 kUp{0, 0, 1};
constexpr double kRounding = 0x1p-50;  // some ten roundings of 2^-53

glm::dvec3 leaning(double angle, double around = 0) {
  return {std::sin(angle) * std::cos(around), std::sin(angle) * std::sin(around), std::cos(angle)};
}

TEST(ToonModel, TonesAreFlatBetweenTheRamps) {
  EXPECT_EQ(toonTone(-0.5), 0);
  EXPECT_EQ(toonTone(0), 0);
  for (const double cosine : {1.0 / 32, 0.1, 0.25}) EXPECT_EQ(toonTone(cosine), 0.25);
  for (const double cosine : {0.25 + 1.0 / 32, 0.5, 0.625}) EXPECT_EQ(toonTone(cosine), 0.625);
  for (const double cosine : {0.625 + 1.0 / 32, 0.9, 1.0}) EXPECT_EQ(toonTone(cosine), 1);
  EXPECT_EQ(toonTone(1.0 / 64), 0.125);
}

TEST(ToonModel, HighlightIsWhereTheLobeReachesOneHalf) {
  for (const double lobe : {0.0, 0.3, 0.5}) EXPECT_EQ(toonHighlight(lobe), 0);
  EXPECT_EQ(toonHighlight(0.5 + 1.0 / 64), 0.5);
  for (const double lobe : {0.5 + 1.0 / 32, 0.7, 1.0}) EXPECT_EQ(toonHighlight(lobe), 1);
}

// All of D, G and F are known there: D = (n + 2)/(2π), G = 1, F = F0.
TEST(CookTorranceModel, PeaksAtTheSpecularColourTimesNPlusTwoEighths) {
  for (const double n : {0.0, 1.0, 30.0, 1e4, 1e6})
    EXPECT_NEAR(cookTorrance({kUp, kUp, kUp}, 0.3, n), 0.3 * (n + 2) / 8, kRounding * n + kRounding) << n;
}

TEST(CookTorranceModel, AtAGlanceReflectsAsWhiteUnlessItIsBlack) {
  const Directions glance{kUp, leaning(1.57), leaning(1.57, std::numbers::pi)};
  const double white = cookTorrance(glance, 1, 100);
  // (1 − V·H)⁵ is within 5·cos(1.57) = 0.004 of 1.
  for (const double f0 : {0.02, 0.3}) EXPECT_NEAR(cookTorrance(glance, f0, 100), white, 0.004 * white);
  EXPECT_EQ(cookTorrance(glance, 0, 100), 0);
}

TEST(CookTorranceModel, LightAndEyeMayChangePlaces) {
  const glm::dvec3 a = leaning(0.3, 1), b = leaning(1.2, 2);
  // What is reflected has the light's cosine in it.
  EXPECT_NEAR(cookTorrance({kUp, a, b}, 0.3, 20) / std::cos(0.3),
              cookTorrance({kUp, b, a}, 0.3, 20) / std::cos(1.2), kRounding * 20);
}

/// The share of a parallel light that goes anywhere, of a white surface; midpoints of a grid.
double wholeReflectance(double n, double angle) {
  constexpr int kSteps = 200;
  const double step = std::numbers::pi / 2 / kSteps;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i)
    for (int j = 0; j < 4 * kSteps; ++j) {
      const double away = (i + 0.5) * step, around = (j + 0.5) * step;
      const double radiance = cookTorrance({kUp, leaning(angle), leaning(away, around)}, 1, n);
      sum += radiance / std::numbers::pi * std::cos(away) * std::sin(away) * step * step;
    }
  return sum / std::cos(angle);
}

// Single scattering loses what hits a second facet: nothing where the surface is smooth. At n = 0 (α = 1) and
// normal incidence D = 1/π, the maskings are 1/2 and 1/(1 + c), and ∫ c/(1 + c) dc from 0 to 1 is 1 − ln 2.
TEST(CookTorranceModel, NeverReflectsMoreThanItGetsAndNearlyAllWhereSmooth) {
  for (const double angle : {0.0, 0.8, 1.4}) {
    EXPECT_LE(wholeReflectance(0, angle), 1) << angle;
    // Midpoints of a twelfth of the lobe's width are exact to far less than this.
    EXPECT_LE(wholeReflectance(200, angle), 1.001) << angle;
  }
  EXPECT_GE(wholeReflectance(200, 0.3), 0.97);
  // Midpoints err by h²/24 of the second derivative, which is some units, over a quarter turn.
  EXPECT_NEAR(wholeReflectance(0, 0), 1 - std::numbers::ln2, 1e-4);
}

// σ² = 1/(n + 2): A = 1 − ½/(1 + 0.33·(n + 2)) and B = 0.45/(1 + 0.09·(n + 2)). Towards the light α = β = θ.
TEST(OrenNayarModel, IsThePapersFormulaWhereThatIsKnown) {
  for (const double n : {0.0, 3.0, 100.0}) {
    const double a = 1 - 0.5 / (1 + 0.33 * (n + 2)), b = 0.45 / (1 + 0.09 * (n + 2));
    EXPECT_NEAR(orenNayar({kUp, kUp, kUp}, n), a, kRounding) << n;
    for (const double angle : {0.1, 0.8, 1.5}) {
      const double s = std::sin(angle), c = std::cos(angle);
      EXPECT_NEAR(orenNayar({kUp, leaning(angle), leaning(angle)}, n), a * c + b * s * s, kRounding) << n;
      // Across the normal, and to the side, there is no second term.
      EXPECT_NEAR(orenNayar({kUp, leaning(angle), leaning(angle, std::numbers::pi)}, n), a * c, kRounding);
    }
  }
}

TEST(OrenNayarModel, IsLambertsWhereSmoothAndLightAndEyeMayChangePlaces) {
  const glm::dvec3 l = leaning(0.3, 1), v = leaning(1.2, 2);
  EXPECT_NEAR(orenNayar({kUp, l, v}, 1e12), l.z, 1e-11);
  EXPECT_NEAR(orenNayar({kUp, l, v}, 1) / l.z, orenNayar({kUp, v, l}, 1) / v.z, kRounding);
}

// Also at a glance, where Cook and Torrance's highlight is brightest, and with the light almost behind. Each
// bound of diffuse light is reached by some surface.
TEST(Models, StayWithinTheBoundsThatTheyState) {
  std::vector<glm::dvec3> directions;
  for (const double angle : {0.0, 0.02, 0.1, 0.3, 0.6, 0.9, 1.2, 1.4, 1.5, 1.55, 1.57})
    for (const double around : {0.0, 0.1, 1.0, 2.0, 3.0, std::numbers::pi})
      directions.push_back(leaning(angle, around));
  for (const Model model : kAllModels) {
    double brightest = 0;
    for (const double n : {0.0, 0.5, 1.0, 3.0, 8.0, 30.0, 100.0, 1e4, 1e6})
      for (const double f0 : {0.0, 0.004, 0.02, 0.3, 1.0, 2.0})
        for (const glm::dvec3& to_light : directions)
          for (const glm::dvec3& to_eye : directions) {
            const Reflected seen = reflectedLight(model, {kUp, to_light, to_eye}, glm::dvec3(f0), n);
            const ModelBounds most = modelBounds(model, f0, n);
            // N·H rounds, which an exponent of 10⁶ makes 10⁶ times as much.
            ASSERT_LE(seen.diffuse, most.diffuse + kRounding) << modelName(model) << " n " << n;
            ASSERT_LE(seen.specular.x, most.specular * (1 + 1e6 * kRounding))
                << modelName(model) << " n " << n << " f0 " << f0;
            brightest = std::max(brightest, seen.diffuse / most.diffuse);
          }
    EXPECT_GT(brightest, 0.999) << modelName(model);
  }
}

TEST(Models, OnlyToonAndOrenNayarChangeDiffuseLight) {
  const Directions at{kUp, leaning(1.0), leaning(0.2)};
  for (const Model model : kAllModels) {
    const double diffuse = reflectedLight(model, at, glm::dvec3(0), 10).diffuse;
    if (model == Model::kOrenNayar)
      EXPECT_EQ(diffuse, orenNayar(at, 10));
    else
      EXPECT_EQ(diffuse, model == Model::kToon ? 0.625 : at.to_light.z) << modelName(model);
  }
}

}  // namespace
}  // namespace luciole::test
