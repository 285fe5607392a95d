#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "gbuffer/packed_normal.hpp"
#include "kernels/probe.hpp"
#include "kernels/random_scene.hpp"

namespace luciole::test {
namespace {

constexpr double kUnit = 0x1p-24;

TEST(TangentKernels, ArePerpendicularToTheNormalsAtEveryWidth) {
  Random random(4);
  std::vector<Column> in(4);
  std::vector<glm::dvec3> packed;
  for (int i = 0; i < 2000; ++i) {
    const glm::vec3 normal(random.direction());
    const std::uint32_t bits = packNormal(glm::cross(glm::dvec3(normal), random.direction()));
    packed.push_back(unpackNormal(bits));
    in[0].push_back(std::bit_cast<float>(bits));
    for (int c = 0; c < 3; ++c) in[c + 1].push_back(normal[c]);
  }
  std::vector<Column> of_one;
  for (const int lanes : kAllLanes) {
    const std::vector<Column> out =
        probe(deviceWithLanes(lanes), "tangents_probe.cl", "probe_tangents", in, 6);
    if (lanes == 1) of_one = out;
    EXPECT_EQ(out, of_one) << lanes << " lanes";
    for (std::size_t i = 0; i < packed.size(); ++i) {
      const glm::dvec3 normal(in[1][i], in[2][i], in[3][i]), tangent(out[0][i], out[1][i], out[2][i]),
          bitangent(out[3][i], out[4][i], out[5][i]);
      // Unpacking, three components of the difference and normalizing round by less than 4 u along the
      // normal; all else is a share of 6.5e-5.
      ASSERT_LE(std::abs(glm::dot(normal, tangent)), 8 * kUnit);
      ASSERT_NEAR(glm::length(tangent), 1, 8 * kUnit);
      ASSERT_LE(glm::distance(tangent, packed[i]), 6.5e-5 + 8 * kUnit);
      ASSERT_LE(glm::distance(bitangent, glm::cross(normal, tangent)), 8 * kUnit);
    }
  }
}

}  // namespace
}  // namespace luciole::test
