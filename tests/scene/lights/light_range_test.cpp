#include "scene/lights/light_range.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>

#include "luciole/error.hpp"
#include "scene/lights/light_field.hpp"

namespace luciole {
namespace {

std::vector<Light> someLights(FieldShape shape, std::uint64_t count, std::uint64_t seed) {
  LightField field = fieldInBox(shape, {{-20, 0, -10}, {20, 5, 10}});
  field.count = count;
  field.seed = seed;
  Scene scene;
  expandLightField(field, scene);
  return scene.lights;
}

std::vector<glm::dvec3> somePoints(std::uint64_t count) {
  std::vector<glm::dvec3> points;
  for (const Light& light : someLights(FieldShape::kBox, count, 99)) points.push_back(light.position);
  return points;
}

/// Pairs of a point and a light nearer to it than the range.
double pairsInRange(const std::vector<Light>& lights, const std::vector<glm::dvec3>& points, float range) {
  double count = 0;
  for (const glm::dvec3& point : points) {
    for (const Light& light : lights) {
      const glm::dvec3 d = light.position - point;
      count += d.x * d.x + d.y * d.y + d.z * d.z < double(range) * range;
    }
  }
  return count;
}

TEST(LightRange, DensityIsReachedAndNoSmallerRangeReachesIt) {
  const std::vector<glm::dvec3> points = somePoints(50);
  for (const FieldShape shape :
       {FieldShape::kBox, FieldShape::kSphere, FieldShape::kClusters, FieldShape::kCurve}) {
    for (const std::uint64_t count : {1, 63, 64, 65, 3000}) {
      const std::vector<Light> lights = someLights(shape, count, count);
      for (const double density : {0.001, 0.02, 0.33, 1.0, 8.0, 63.5, 1500.0, 2999.98}) {
        const float range = rangeForDensity(lights, points, density);
        const double wanted = std::min(density * 50, 50.0 * double(count));
        EXPECT_GE(pairsInRange(lights, points, range), wanted) << count << " " << density;
        EXPECT_LT(pairsInRange(lights, points, std::nextafter(range, 0.0f)), wanted)
            << count << " " << density;
      }
    }
  }
}

TEST(LightRange, MoreThanAllLightsIsAllOfThem) {
  const std::vector<Light> lights = someLights(FieldShape::kBall, 100, 1);
  const std::vector<glm::dvec3> points = somePoints(7);
  const float range = rangeForDensity(lights, points, 1e18);
  EXPECT_EQ(pairsInRange(lights, points, range), 700);
  EXPECT_LT(pairsInRange(lights, points, std::nextafter(range, 0.0f)), 700);
  EXPECT_EQ(rangeForDensity(lights, points, 100), range);
}

TEST(LightRange, ThousandLightsInOnePlaceCountAThousandTimes) {
  const std::vector<Light> lights(1000);
  const glm::dvec3 points[]{{3, 4, 0}, {0, 0, 10}};
  // The nearer point has all 1000, a mean of 500.
  EXPECT_EQ(rangeForDensity(lights, points, 500), std::nextafter(5.0f, 6.0f));
  EXPECT_EQ(rangeForDensity(lights, points, 500.5), std::nextafter(10.0f, 11.0f));
}

TEST(LightRange, LightAtAPointHasTheSmallestRange) {
  const std::vector<Light> lights(1);
  const glm::dvec3 points[]{glm::dvec3(0)};
  EXPECT_EQ(rangeForDensity(lights, points, 1), 1e-18f);
}

TEST(LightRange, LargestAndSmallestScenesHaveOne) {
  std::vector<Light> lights(2);
  for (const double unit : {1e18, 1e-15}) {
    lights[0].position = glm::dvec3(-unit, 0, 0);
    lights[1].position = glm::dvec3(unit, 0, 0);
    const std::vector<glm::dvec3> points{{-unit, unit, 0}};
    for (const double density : {1.0, 2.0}) {
      const float range = rangeForDensity(lights, points, density);
      EXPECT_EQ(pairsInRange(lights, points, range), density);
      EXPECT_LT(pairsInRange(lights, points, std::nextafter(range, 0.0f)), density);
    }
  }
}

TEST(LightRange, NothingToReachIsInfinite) {
  EXPECT_TRUE(std::isinf(rangeForDensity({}, somePoints(1), 1)));
  EXPECT_TRUE(std::isinf(rangeForDensity(std::vector<Light>(1), {}, 1)));
}

TEST(LightRange, OrderAndThreadsDoNotMatter) {
  std::vector<Light> lights = someLights(FieldShape::kClusters, 20'000, 5);
  std::vector<glm::dvec3> points = somePoints(100);
  const float range = rangeForDensity(lights, points, 8);
  std::reverse(lights.begin(), lights.end());
  std::reverse(points.begin(), points.end());
  const tbb::global_control single(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(rangeForDensity(lights, points, 8), range);
}

TEST(LightRange, CutoffIsTheRootOfBrightestOverIt) {
  Light light;
  light.diffuse = {1, 9, 4};
  EXPECT_EQ(rangeForCutoff(light, 0.25), 6);
  light.diffuse = glm::vec3(1e38f);
  EXPECT_EQ(rangeForCutoff(light, 1e-18), 1e18f);
}

/// Light that arrives at the points on average, without regard to direction, by the formulae of FORMATS.md.
double meanLight(const std::vector<Light>& lights, const std::vector<glm::dvec3>& points) {
  double sum = 0;
  for (const glm::dvec3& point : points) {
    for (const Light& light : lights) {
      const double d = glm::distance(light.position, point), share = d / light.range;
      const double window = share < 1 ? std::pow(1 - std::pow(share, 4), 2) : 0;
      const glm::dvec3 a = light.attenuation;
      sum += window * glm::dot(glm::dvec3(light.diffuse), glm::dvec3(1)) / (a.x + a.y * d + a.z * d * d);
    }
  }
  return sum / double(points.size());
}

TEST(RemoveRanges, KeepsTheMeanLightWhateverTheCountAndTheShape) {
  const std::vector<glm::dvec3> points = somePoints(200);
  for (const FieldShape shape : {FieldShape::kBox, FieldShape::kClusters, FieldShape::kCurve}) {
    for (const std::uint64_t count : {1, 200, 3000}) {
      std::vector<Light> lights = someLights(shape, count, count);
      const float range = rangeForDensity(lights, points, kUsualDensity);
      for (Light& light : lights) light.range = range;
      // A point this near to a light counts as farther off; none is.
      for (const glm::dvec3& point : points)
        std::erase_if(lights, [&](const Light& light) {
          return glm::distance(light.position, point) < 0.01 * double(range);
        });
      const double wanted = meanLight(lights, points);
      removeRanges(lights, points);
      for (const Light& light : lights) {
        ASSERT_TRUE(std::isinf(light.range));
        ASSERT_EQ(light.attenuation, glm::vec3(0, 0, 1));
      }
      // The factor and the colours are rounded to float.
      EXPECT_NEAR(meanLight(lights, points), wanted, 3 * 0x1p-24 * wanted) << count;
    }
  }
}

TEST(RemoveRanges, APointAtALightCountsAsAHundredthOfItsRangeAway) {
  std::vector<Light> lights(1);
  lights[0].range = 200;
  removeRanges(lights, std::vector<glm::dvec3>{glm::dvec3(0)});
  // It had 1, and would have 1/2² at two metres.
  EXPECT_EQ(lights[0].diffuse, glm::vec3(4));
}

TEST(RemoveRanges, BlackLightsAndNoPointsLeaveColoursAlone) {
  std::vector<Light> lights(1);
  removeRanges(lights, {});
  EXPECT_EQ(lights[0].diffuse, glm::vec3(1));
  lights[0].diffuse = glm::vec3(0);
  removeRanges(lights, somePoints(3));
  EXPECT_EQ(lights[0].diffuse, glm::vec3(0));
}

TEST(RemoveRanges, LightsThatReachedNothingAreRefused) {
  std::vector<Light> lights(1);
  lights[0].range = 1;
  EXPECT_THROW(removeRanges(lights, std::vector<glm::dvec3>{{2, 0, 0}}), InputError);
}

TEST(RemoveRanges, ThreadsDoNotMatter) {
  std::vector<Light> lights = someLights(FieldShape::kClusters, 5000, 5), others;
  for (Light& light : lights) light.range = 1;
  others = lights;
  const std::vector<glm::dvec3> points = somePoints(100);
  removeRanges(lights, points);
  const tbb::global_control single(tbb::global_control::max_allowed_parallelism, 1);
  removeRanges(others, points);
  for (std::size_t i = 0; i < lights.size(); ++i) ASSERT_EQ(lights[i].diffuse, others[i].diffuse);
}

}  // namespace
}  // namespace luciole
