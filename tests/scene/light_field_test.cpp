#include "scene/light_field.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "error.hpp"

namespace luciole {
namespace {

std::vector<Light> expand(const LightField& field) {
  std::vector<Light> lights;
  expandLightField(field, lights);
  return lights;
}

TEST(LightField, FirstLightsAreTheSameOnEveryMachine) {
  // From SplitMix64 written in Python, seed 1 for places and ~1 for looks, exact to the bit.
  LightField field;
  field.count = 2;
  field.seed = 1;
  field.low = {-1, 0, 5};
  field.high = {3, 2, 6};
  field.colors = {{1, 0, 0}, {0, 1, 0}};
  field.intensity = {2, 4};
  field.range = {1, 3};
  const std::vector<Light> lights = expand(field);
  ASSERT_EQ(lights.size(), 2u);
  EXPECT_EQ(lights[0].position, glm::dvec3(1.2662463006891236, 1.4915635145254023, 5.971002753586796));
  EXPECT_EQ(lights[1].position, glm::dvec3(0.7774368682230883, 0.8885294016527161, 5.762894391911761));
  EXPECT_EQ(lights[0].diffuse, glm::vec3(0, static_cast<float>(2 + 2 * 0.7278836129897747), 0));
  EXPECT_EQ(lights[1].diffuse, glm::vec3(static_cast<float>(2 + 2 * 0.4697649529128548), 0, 0));
  EXPECT_EQ(lights[0].range, static_cast<float>(1 + 2 * 0.8157512234965084));
  EXPECT_EQ(lights[1].range, static_cast<float>(1 + 2 * 0.8451342365454623));

  field.shape = FieldShape::kBall;
  EXPECT_EQ(expand(field)[0].position,
            glm::dvec3(-0.11128156588845584, -0.1114705983472839, 0.525788783823522));
  field.shape = FieldShape::kSphere;
  EXPECT_EQ(expand(field)[0].position,
            glm::dvec3(0.22913329545616867, 0.8460855059220949, 0.4812870760595477));
}

TEST(LightField, SmallerCountGivesTheFirstLightsOfALarger) {
  LightField field;
  field.shape = FieldShape::kBall;
  field.count = 1000;
  const std::vector<Light> many = expand(field);
  field.count = 10;
  const std::vector<Light> few = expand(field);
  for (std::size_t i = 0; i < few.size(); ++i) EXPECT_EQ(few[i].position, many[i].position);
}

TEST(LightField, LooksMoveNoLightAndSeedsDo) {
  LightField field;
  field.count = 3;
  const std::vector<Light> plain = expand(field);
  field.colors.emplace_back(1, 0, 0);
  field.colors.emplace_back(0, 1, 0);
  field.range = {2, 9};
  EXPECT_EQ(expand(field)[2].position, plain[2].position);
  field.seed = 1;
  EXPECT_NE(expand(field)[2].position, plain[2].position);
}

TEST(LightField, ShapesAreFilledEvenly) {
  constexpr int kCount = 100'000;
  LightField field;
  field.count = kCount;
  field.center = {10, -20, 30};
  field.radius = 2;
  const auto means = [&](FieldShape shape) {
    field.shape = shape;
    const glm::dvec3 center = shape == FieldShape::kBox ? glm::dvec3(0.5) : field.center;
    glm::dvec3 mean{0.0}, square{0.0};
    for (const Light& light : expand(field)) {
      const glm::dvec3 p = light.position - center;
      if (shape == FieldShape::kBox) {
        EXPECT_LE(std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}), 0.5);
      }
      // Coordinates up to 32 have an error of 2⁻⁴⁸ in each of centre + offset and back, over three
      // components; the point on the unit sphere has some 2⁻⁵² of its own: below 2·10⁻¹⁴ m together.
      if (shape == FieldShape::kBall) {
        EXPECT_LE(glm::length(p), 2 + 2e-14);
      }
      if (shape == FieldShape::kSphere) {
        EXPECT_NEAR(glm::length(p), 2, 2e-14);
      }
      mean += p / double(kCount);
      square += p * p / double(kCount);
    }
    return std::pair(mean, square);
  };
  // Moments of one coordinate: E x², E x⁴. Six standard errors: sqrt(E x² / n) of the mean, sqrt((E x⁴ − (E
  // x²)²) / n) of the mean square.
  const auto check = [&](FieldShape shape, double second, double fourth) {
    const auto [mean, square] = means(shape);
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(mean[i], 0, 6 * std::sqrt(second / kCount)) << int(shape);
      EXPECT_NEAR(square[i], second, 6 * std::sqrt((fourth - second * second) / kCount)) << int(shape);
    }
  };
  const double r2 = 4;
  check(FieldShape::kBox, 1.0 / 12, 1.0 / 80);
  check(FieldShape::kBall, r2 / 5, 3 * r2 * r2 / 35);
  check(FieldShape::kSphere, r2 / 3, r2 * r2 / 5);
}

TEST(LightField, TooManyLightsAreRefusedBeforeAnyIsMade) {
  LightField field;
  field.count = kMostLights;
  std::vector<Light> lights(1);
  EXPECT_THROW(expandLightField(field, lights), InputError);
  field.count = ~std::uint64_t{0};
  EXPECT_THROW(expandLightField(field, lights), InputError);
  EXPECT_EQ(lights.size(), 1u);
}

}  // namespace
}  // namespace luciole
