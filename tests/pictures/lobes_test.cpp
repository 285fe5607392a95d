// Highlights of exponents from 0 to 10⁶, whose lobe ends within 0.2 degrees: cos α rounds to a float before
// the power, and the 10⁶th power of one rounding of a cosine near 1 is 6 %.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kernels/random_scene.hpp"
#include "pictures/surfaces_seen.hpp"

namespace luciole::test {
namespace {

/// How far down a lobe is looked at: half a step of 8 bits.
constexpr double kFaintest = 1.0 / 512;

/// Points that see the highlight of a light at a place, from its peak down to about kFaintest of it.
std::vector<SurfaceSeen> highlightPoints(const glm::dvec3& light, float exponent, bool blinn,
                                         Random& random) {
  std::vector<SurfaceSeen> points;
  while (points.size() < 4096) {
    SurfaceSeen seen;
    const double depth = random.between(2, 30);
    seen.position = glm::vec3(depth * random.between(-0.5, 0.5), depth * random.between(-0.5, 0.5), -depth);
    seen.diffuse = glm::vec3(0);
    seen.specular = glm::vec3(1);
    seen.shininess = exponent;
    const glm::dvec3 position(seen.position);
    const glm::dvec3 to_light = glm::normalize(light - position), to_eye = -glm::normalize(position);
    // Where the light grazes, the half vector is short and Blinn's lobe loses what it is short of.
    if (glm::length(to_light + to_eye) < 0.5) continue;
    // cosⁿ has faded to f at an angle of √(−2·ln f / n); a turn of the normal turns the mirrored light twice.
    const double widest = std::sqrt(-2 * std::log(kFaintest) / exponent) / (blinn ? 1 : 2);
    const glm::dvec3 half_way = glm::normalize(to_light + to_eye);
    const glm::dvec3 aside = glm::normalize(glm::cross(half_way, random.direction()));
    const double angle = widest * random.between(0, 1);
    seen.normal = glm::vec3(std::cos(angle) * half_way + std::sin(angle) * aside);
    points.push_back(seen);
  }
  return points;
}

/// The largest errors of what was seen of some highlights.
struct LobeErrors {
  double relative = 0;  ///< to the exact value, where that is kFaintest or more
  double of_bound = 0;  ///< as a share of what the roundings can come to in the worst case
};

// The kernel takes the lobe from t = |a − b|²/2 = 1 − cosine, so d(lobe)/lobe = n·dt, and an error δ of the
// vector a − b along itself makes dt = √(2t)·δ. Lengths of a and b don't matter: an error along a is at right
// angles to a − b. In units of 2^-24, with θ the angle of incidence, the worst that roundings can do:
//   both: V's product 1, L's difference and product 2;
//   Phong: N·L has 3, which move R along N, 2·3·sin θ of it along a − b; a normal's length is 1 off, which
//   makes 2·sin 2θ; R's products and differences 2·cos θ + 1: together below 13 for any θ;
//   Blinn: L + V has 2/|L + V|, by which its other errors, (1 + 2), are divided too; lengths of L and V off
//   by 2 each tilt it by 4·tan θ/2; its scaling rounds 1: with |L + V| ≥ ½, tan θ ≤ 3.9, below 19.
// At n = 10⁶ a lobe of 1/512 has √(2t)·n = 3533, so that 10⁻³ is 4.7 units: less than the worst case, which
// would need every rounding at its largest and all to the same side, and more than roundings do.
LobeErrors lobeErrors(const std::vector<SurfaceSeen>& points, const std::vector<glm::vec3>& got,
                      const std::vector<glm::vec3>& truth, bool blinn) {
  LobeErrors worst;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double exact = truth[i].x, n = points[i].shininess;
    if (exact < kFaintest) continue;
    const double relative = std::abs(got[i].x - exact) / exact;
    const double t = -std::log(exact) / n;
    const double delta = (blinn ? 19 : 13) * kUnit;
    // Roundings of t itself: 5, and 3 of the power, whose exponent is within 5; 3 of the result.
    const double bound = n * (std::sqrt(2 * t) * delta + delta * delta / 2 + 10 * t * kUnit) + 7 * kUnit;
    worst.relative = std::max(worst.relative, relative);
    worst.of_bound = std::max(worst.of_bound, relative / bound);
  }
  return worst;
}

class HardLobes : public testing::TestWithParam<int> {};

TEST_P(HardLobes, ExponentsUpToAMillionKeepAThousandthOfTheLobe) {
  for (const bool blinn : {false, true}) {
    for (const float exponent : {1e4f, 1e5f, 1e6f}) {
      Random random{unsigned(exponent)};
      LobeErrors worst;
      for (int round = 0; round < 3; ++round) {
        Light light =
            pointLight(glm::vec3(random.between(-5, 5), random.between(-5, 5), random.between(-20, 5)));
        light.diffuse = glm::vec3(0);
        const Scene scene = sceneWith({light});
        const auto points = highlightPoints(light.position, exponent, blinn, random);
        const LobeErrors errors = lobeErrors(
            points,
            shadedPoints(GetParam(), scene, points, {.model = blinn ? Model::kBlinnPhong : Model::kPhong}),
            referencePoints(scene, points, blinn ? Model::kBlinnPhong : Model::kPhong), blinn);
        worst.relative = std::max(worst.relative, errors.relative);
        worst.of_bound = std::max(worst.of_bound, errors.of_bound);
      }
      EXPECT_LE(worst.relative, 1e-3) << exponent << (blinn ? " Blinn" : " Phong");
      EXPECT_LE(worst.of_bound, 1) << exponent << (blinn ? " Blinn" : " Phong");
      RecordProperty(fmt::format("{}_{}", blinn ? "blinn" : "phong", exponent),
                     fmt::format("{:.3g}, {:.3g} of the bound", worst.relative, worst.of_bound));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Lanes, HardLobes, testing::ValuesIn(widths()), testing::PrintToStringParamName());

TEST(HardLobeEnds, ZeroToTheZeroIsOne) {
  // Seen at a slant from the light's own side, R·V is −0.28; seen straight on, 7/√65. With exponent 0 every
  // highlight is whole.
  const SurfaceSeen straight{.position = {0, 0, -4}, .diffuse = glm::vec3(0), .specular = glm::vec3(1)};
  SurfaceSeen slanted = straight;
  slanted.position = {-4, 0, -3};
  const Scene scene = sceneWith({pointLight({4, 0, 3})});
  const auto truth = referencePoints(scene, {straight, slanted});
  EXPECT_EQ(truth, std::vector<glm::vec3>(2, glm::vec3(1)));
  for (const int lanes : widths()) EXPECT_EQ(shadedPoints(lanes, scene, {straight, slanted}), truth) << lanes;
}

}  // namespace
}  // namespace luciole::test
