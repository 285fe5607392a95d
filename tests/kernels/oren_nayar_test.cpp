#include <gtest/gtest.h>

#include "kernels/probe.hpp"
#include "kernels/random_scene.hpp"
#include "kernels/shade_bounds.hpp"

namespace luciole::test {
namespace {

/// A direction whose cosine with the normal is this.
glm::dvec3 leaning(const glm::dvec3& normal, double cosine, Random& random) {
  const glm::dvec3 aside = glm::normalize(glm::cross(normal, random.direction()));
  return cosine * normal + std::sqrt(1 - cosine * cosine) * aside;
}

/// Steep and grazing light and eyes, some of them behind the surface, and surfaces from the roughest on.
std::vector<Column> manyPlaces(Random& random) {
  std::vector<Column> in(10);
  for (int i = 0; i < 4000; ++i) {
    const glm::dvec3 normal = random.direction();
    const auto side = [&](double behind) { return random.chance(behind) ? -1.0 : 1.0; };
    const glm::dvec3 to_light = leaning(normal, side(0.1) * std::exp2(-random.between(0, 20)), random);
    glm::dvec3 to_eye = leaning(normal, side(0.1) * std::exp2(-random.between(0, 20)), random);
    if (random.chance(0.3))
      to_eye = glm::normalize(to_light + std::exp2(-random.between(0, 20)) * random.direction());
    const glm::vec3 rounded[]{normal, to_light, to_eye};
    for (int c = 0; c < 9; ++c) in[std::size_t(c)].push_back(rounded[c / 3][c % 3]);
    in[9].push_back(std::array{0.0f, 1.0f, 32.0f, 1e6f}[std::size_t(random.below(4))]);
  }
  return in;
}

TEST(OrenNayarKernel, IsTheReferencesAtEveryWidthAndBlackWhereItFacesAway) {
  Random random(7);
  const std::vector<Column> in = manyPlaces(random);
  for (const int lanes : kAllLanes) {
    const Column out = probe(deviceWithLanes(lanes), "oren_nayar_probe.cl", "probe_oren_nayar", in, 1)[0];
    for (std::size_t i = 0; i < out.size(); ++i) {
      const auto unit = [&](std::size_t c) {
        return glm::normalize(glm::dvec3(in[c][i], in[c + 1][i], in[c + 2][i]));
      };
      const glm::dvec3 normal = unit(0), to_eye = unit(6);
      // The vectors' lengths are off by 2 roundings at most, as directions they are exact.
      const WayToLight way{.unit = unit(3), .error = 2 * kUnit};
      const Interval bounds = orenNayarInterval(normal, way, to_eye, in[9][i]);
      EXPECT_GE(out[i], bounds.low) << i << ", " << lanes << " lanes";
      EXPECT_LE(out[i], bounds.high) << i << ", " << lanes << " lanes";
      const double cosine = glm::dot(normal, way.unit);
      if (cosine < -4 * kUnit) {
        EXPECT_EQ(out[i], 0.0f);
      }
      if (cosine <= 0) continue;
      const double exact = orenNayar({normal, way.unit, to_eye}, in[9][i]);
      EXPECT_TRUE(exact >= bounds.low && exact <= bounds.high) << i << ": the reference's " << exact;
    }
  }
}

}  // namespace
}  // namespace luciole::test
