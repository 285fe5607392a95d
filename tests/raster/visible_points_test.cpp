#include "raster/visible_points.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "raster/raster_scenes.hpp"
#include "scene/bounds.hpp"

namespace luciole::test {
namespace {

/// Whose unit of length is a pixel of a picture this high; moved away from the origin.
Camera pixelCamera(int height) {
  Camera camera = frontCamera();
  camera.orthographic = true;
  camera.half_height = 0.5 * height;
  camera.camera_to_world[3] = {1000, 2000, 3000, 1};
  return camera;
}

Scene movedRectangle(float half_width, float half_height) {
  Scene scene = rectangleScene(half_width, half_height, -2);
  scene.objects[0].object_to_world[3] = {1000, 2000, 3000, 1};
  return scene;
}

TEST(VisiblePoints, AreAllCoveredPixelsWhereTheyAreFewer) {
  const std::vector<glm::dvec3> points = visiblePoints(movedRectangle(2, 1), pixelCamera(8), {8, 8}, 1000, 1);
  ASSERT_EQ(points.size(), 8u);
  std::set<std::pair<double, double>> places;
  for (const glm::dvec3& point : points) {
    EXPECT_EQ(point.z, 2998);
    places.emplace(point.x - 1000, point.y - 2000);
  }
  for (double x : {-1.5, -0.5, 0.5, 1.5}) {
    for (double y : {-0.5, 0.5}) EXPECT_TRUE(places.contains({x, y})) << x << " " << y;
  }
  EXPECT_TRUE(visiblePoints({}, pixelCamera(8), {8, 8}, 10, 1).empty());
  EXPECT_TRUE(visiblePoints(movedRectangle(2, 1), pixelCamera(8), {8, 8}, 0, 1).empty());
}

TEST(VisiblePoints, AreDifferentPixelsSpreadEvenlyAndTheSameForASeed) {
  const Scene scene = movedRectangle(64, 64);
  const auto pick = [&](std::uint64_t seed) {
    return visiblePoints(scene, pixelCamera(128), {128, 128}, 1000, seed);
  };
  const std::vector<glm::dvec3> points = pick(1);
  ASSERT_EQ(points.size(), 1000u);
  EXPECT_EQ(points, pick(1));
  EXPECT_NE(points, pick(2));
  std::set<std::pair<double, double>> places;
  int left = 0, upper = 0;
  for (const glm::dvec3& point : points) {
    places.emplace(point.x, point.y);
    left += point.x < 1000;
    upper += point.y > 2000;
  }
  EXPECT_EQ(places.size(), 1000u);
  // Five standard errors of a fair coin; without putting back it is less.
  EXPECT_NEAR(left, 500, 5 * std::sqrt(250.0));
  EXPECT_NEAR(upper, 500, 5 * std::sqrt(250.0));
}

TEST(VisiblePoints, PicturesOfSeveralBandsAreSeenWhole) {
  // 129 rows of 32768 pixels are more than 2²² pixels. Of 20 000 points, some 155 lie in each row: none at
  // all with probability e⁻¹⁵⁵.
  const std::vector<glm::dvec3> points =
      visiblePoints(movedRectangle(20000, 100), pixelCamera(129), {32768, 129}, 20'000, 1);
  std::set<double> rows;
  for (const glm::dvec3& point : points) rows.insert(point.y);
  EXPECT_EQ(rows.size(), 129u);
}

TEST(SeenBox, LeavesOutAFewFarPoints) {
  std::vector<glm::dvec3> points;
  for (int i = 0; i < 1000; ++i) points.emplace_back(i, 1000 - i, 2 * i);
  for (int i = 0; i < 40; ++i) points[25 * i] = glm::dvec3(1e9);
  const Bounds box = seenBox(points, glm::dvec3(0));
  for (int axis = 0; axis < 3; ++axis) {
    // 51 values are cut on either side: 40 far ones and 11 more above.
    EXPECT_LT(box.high[axis], 2000);
    EXPECT_GT(box.high[axis], 950);
    EXPECT_LT(box.low[axis], 150);
    EXPECT_GE(box.low[axis], 0);
  }
}

TEST(SeenBox, FloorAloneGetsAHeightTowardsTheEye) {
  std::vector<glm::dvec3> points;
  for (int i = 0; i <= 100; ++i) points.emplace_back(i, 3, i);
  Bounds box = seenBox(points, {0, 10, 0});
  EXPECT_EQ(box.low, glm::dvec3(5, 3, 5));
  EXPECT_EQ(box.high, glm::dvec3(95, 12, 95));
  box = seenBox(points, {0, -10, 0});
  EXPECT_EQ(box.low, glm::dvec3(5, -6, 5));
  EXPECT_EQ(box.high, glm::dvec3(95, 3, 95));
}

}  // namespace
}  // namespace luciole::test
