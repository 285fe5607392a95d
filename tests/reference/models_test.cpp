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

TEST(WardModel, PeaksAtNPlusTwoEighthsAndGrowsAtAGlance) {
  for (const double n : {0.0, 1.0, 30.0, 1e4, 1e6}) {
    EXPECT_NEAR(ward({kUp, kUp, kUp}, n), (n + 2) / 8, kRounding * (n + 2)) << n;
    // Towards the mirror h is along the normal: N·L (n + 2)/2 / (2 N·L)².
    for (const double angle : {0.4, 1.2, 1.55}) {
      const double mirrored = ward({kUp, leaning(angle), leaning(angle, std::numbers::pi)}, n);
      EXPECT_NEAR(mirrored * std::cos(angle) * 8 / (n + 2), 1, kRounding * (n + 2)) << n << " " << angle;
    }
  }
}

TEST(WardModel, IsThePapersFormulaAwayFromThePeak) {
  const double tangent = std::tan(0.3), expected = std::exp(-tangent * tangent * 16) * 16;
  // L = V, so δ = 0.3, h·h = 4 and h·N = 2 cos 0.3.
  EXPECT_NEAR(ward({kUp, leaning(0.3, 1), leaning(0.3, 1)}, 30), expected * 0.25 / std::pow(std::cos(0.3), 3),
              40 * kRounding);
}

TEST(WardModel, LightAndEyeMayChangePlaces) {
  const glm::dvec3 a = leaning(0.3, 1), b = leaning(1.2, 2);
  for (const double n : {0.0, 3.0, 20.0})
    EXPECT_NEAR(ward({kUp, a, b}, n) / a.z, ward({kUp, b, a}, n) / b.z, kRounding * 20) << n;
  const glm::dvec3 x{0.6, 0.8, 0}, y{-0.8, 0.6, 0};
  EXPECT_NEAR(wardAnisotropic({kUp, a, b}, x, y, {0.2, 0.7}) / a.z,
              wardAnisotropic({kUp, b, a}, x, y, {0.2, 0.7}) / b.z, kRounding * 20);
}

TEST(WardModel, OfABrushedSurfaceSpreadsAcrossTheGroove) {
  const glm::dvec3 x{1, 0, 0}, y{0, 1, 0}, along = leaning(0.6, 0),
                                           across = leaning(0.6, std::numbers::pi / 2);
  const auto seen = [&](const glm::dvec3& to_light) {
    return wardAnisotropic({kUp, to_light, kUp}, x, y, {0.1, 0.5});
  };
  EXPECT_GT(seen(across), 100 * seen(along));
  EXPECT_NEAR(wardAnisotropic({kUp, along, across}, x, y, glm::dvec2(0.25)), ward({kUp, along, across}, 30),
              40 * kRounding);
}

/// The share of a parallel light that goes anywhere, of a white surface. Slopes of h are those that the
/// exponential spreads evenly, r² = −ln u around: dω = 4 (V·h) cos³δ αx αy /(2u) du dψ, by midpoints.
double wardReflectance(glm::dvec2 alpha, double angle, double around) {
  constexpr int kSteps = 200;
  const glm::dvec3 to_eye = leaning(angle, around);
  double sum = 0;
  for (int i = 0; i < kSteps; ++i)
    for (int j = 0; j < 4 * kSteps; ++j) {
      const double u = (i + 0.5) / kSteps, turn = (j + 0.5) / (2 * kSteps) * std::numbers::pi;
      const glm::dvec2 slope = std::sqrt(-std::log(u)) * alpha * glm::dvec2(std::cos(turn), std::sin(turn));
      const glm::dvec3 half_way = glm::normalize(glm::dvec3(slope, 1));
      const double v_dot_h = glm::dot(to_eye, half_way);
      const glm::dvec3 to_light = 2 * v_dot_h * half_way - to_eye;
      if (v_dot_h <= 0 || to_light.z <= 0) continue;
      const double angles = 4 * v_dot_h * std::pow(half_way.z, 3) * alpha.x * alpha.y / (2 * u);
      sum += wardAnisotropic({kUp, to_light, to_eye}, {1, 0, 0}, {0, 1, 0}, alpha) * angles;
    }
  return sum / (2.0 * kSteps * kSteps);
}

// What 2010's correction is for. What is summed is 2 N·L/(N·L + N·V), so all of the light where the surface
// is smooth, and at a glance, where it is 2 for the half of the slopes that face the light.
TEST(WardModel, NeverReflectsMoreThanItGetsAndNearlyAllWhereSmoothOrAtAGlance) {
  for (const double wide : {1.0, 0.5, 0.1, 0.01})
    for (const double narrow : {1.0, 0.3})
      for (const double angle : {0.0, 0.8, 1.4, 1.55, 1.5707})
        for (const double around : {0.0, 0.7, 1.5}) {
          const double share = wardReflectance({wide, narrow * wide}, angle, around);
          // A row of midpoints at the edge of N·L > 0 may count to its end.
          EXPECT_LE(share, 1 + 1.0 / 400) << wide << " " << narrow << " " << angle << " " << around;
          EXPECT_GE(share, wide < 0.05 && angle < 1.5 ? 0.98 : 0.35)
              << wide << " " << narrow << " " << angle << " " << around;
        }
  // From above a slope of T reflects 1 − T of its light, and T spreads as e^-(T/α²).
  for (const double alpha : {1.0, 0.5})
    EXPECT_NEAR(wardReflectance({alpha, alpha}, 0, 0),
                1 - alpha * alpha * (1 - std::exp(-1 / (alpha * alpha))), 1e-4);
  EXPECT_GE(wardReflectance({1, 1}, 1.5707, 0), 0.99);
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
