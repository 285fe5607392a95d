#include "scene/triangulate.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace luciole {
namespace {

TEST(Triangulate, AStarOf255CornersIsCoveredOnceWherever) {
  std::vector<glm::dvec3> star;
  double expected = 0;
  constexpr int kCorners = 254;
  const double step = 2 * std::acos(-1.0) / kCorners;
  for (int i = 0; i < kCorners; ++i) {
    const double radius = i % 2 ? 1 : 3;
    star.emplace_back(1000 + radius * std::cos(i * step), 2000 + radius * std::sin(i * step), -500);
    expected += 0.5 * 1 * 3 * std::sin(step);
  }
  double sum = 0;
  const auto triangles = triangulate(star);
  EXPECT_EQ(triangles.size(), std::size_t{kCorners - 2});
  for (const auto& [a, b, c] : triangles) {
    const double twice = glm::cross(star[b] - star[a], star[c] - star[a]).z;
    EXPECT_GT(twice, 0) << "turned over";
    sum += twice / 2;
  }
  // Corners are rounded to 2^-42 (ulp/2 of 2000 is below it) and edges are at most 6 long: 254 areas, each
  // off by less than 4 x 6 x 2^-42.
  EXPECT_NEAR(sum, expected, kCorners * 4 * 6 * std::ldexp(1.0, -42));
}

TEST(Triangulate, AConvexPolygonBecomesAFan) {
  using Fan = std::vector<std::array<int, 3>>;
  EXPECT_EQ(triangulate({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}), (Fan{{0, 1, 2}, {0, 2, 3}}));
}

TEST(Triangulate, PolygonsWithoutAreaStillEnd) {
  EXPECT_EQ(triangulate(std::vector<glm::dvec3>(9, glm::dvec3(1, 2, 3))).size(), 7u);
  EXPECT_EQ(triangulate({{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}}).size(), 2u) << "a bow tie";
}

/// The sum of the triangles' areas, whichever way they turn: the polygon's where each point of it is covered
/// once.
double covered(const std::vector<glm::dvec3>& polygon) {
  double sum = 0;
  for (const auto& [a, b, c] : triangulate(polygon))
    sum += glm::length(glm::cross(polygon[b] - polygon[a], polygon[c] - polygon[a])) / 2;
  return sum;
}

/// A row of towers of whole heights, some alike, so that corners stand twice and in line, and its area.
std::vector<glm::dvec3> towers(int count, double& area) {
  std::vector<glm::dvec3> polygon{{0, 0, 0}, {count, 0, 0}};
  area = 0;
  for (int i = count; i > 0; --i) {
    const int height = 1 + i * 7919 % 13 % 4;
    polygon.emplace_back(i, height, 0);
    polygon.emplace_back(i - 1, height, 0);
    area += height;
  }
  return polygon;
}

TEST(Triangulate, CornersThatStandTwiceOrInLineAreCoveredOnce) {
  for (const int count : {3, 40, 500, 5000}) {
    double area = 0;
    const std::vector<glm::dvec3> upright = towers(count, area);
    EXPECT_EQ(covered(upright), area) << count << ": of whole numbers";
    if (count > 500) continue;
    // Turned, as a file has it: rounded to floats, so that nothing is quite in line.
    std::vector<glm::dvec3> turned;
    for (const glm::dvec3& p : upright)
      turned.emplace_back(glm::vec3(0.6 * p.x - 0.48 * p.y + 7, 0.8 * p.x + 0.36 * p.y - 3, 0.8 * p.y));
    // Coordinates are off by 2^-25 of `count` at most: slivers of that width and up to `count` long lie
    // beside some edges, not the hundreds of square metres of a tower that is covered twice.
    EXPECT_NEAR(covered(turned), area, std::ldexp(4.0, -25) * count * count) << count;
  }
}

TEST(Triangulate, HolesThatBridgesJoinStayEmpty) {
  // A plate of 7 x 7 with 3 x 3 holes of 1 x 1: a bridge goes along each row of holes, and back again.
  std::vector<glm::dvec3> polygon{{7, 0, 0}, {7, 7, 0}, {0, 7, 0}};
  for (int y = 5; y > 0; y -= 2) {
    polygon.emplace_back(0, y, 0);
    for (int x = 1; x < 7; x += 2) {
      polygon.emplace_back(x, y, 0);
      polygon.emplace_back(x, y + 1, 0);
      polygon.emplace_back(x + 1, y + 1, 0);
      polygon.emplace_back(x + 1, y, 0);
    }
    for (int x = 5; x >= 0; --x) polygon.emplace_back(x, y, 0);
  }
  polygon.emplace_back(0, 0, 0);
  EXPECT_EQ(covered(polygon), 49 - 9);
}

/// A comb of teeth, whose corners between teeth turn right: 4 corners a tooth.
std::vector<glm::dvec3> comb(int teeth) {
  std::vector<glm::dvec3> polygon;
  for (int i = 0; i < teeth; ++i) {
    polygon.emplace_back(2 * i, 100, 0);
    polygon.emplace_back(2 * i, 0, 0);
    polygon.emplace_back(2 * i + 1, 0, 0);
    polygon.emplace_back(2 * i + 1, 100, 0);
  }
  polygon.emplace_back(2 * teeth, 100, 0);
  polygon.emplace_back(2 * teeth, 101, 0);
  polygon.emplace_back(0, 101, 0);
  return polygon;
}

TEST(Triangulate, FacesOfManyCornersAreCutInTime) {
  std::vector<glm::dvec3> disc;
  constexpr int kCorners = 100'000;
  for (int i = 0; i < kCorners; ++i) {
    const double angle = 2 * std::acos(-1.0) * i / kCorners;
    disc.emplace_back(std::cos(angle), std::sin(angle), 0);
  }
  EXPECT_EQ(triangulate(disc).size(), std::size_t(kCorners - 2));
  const std::vector<glm::dvec3> teeth = comb(kCorners / 4);
  double area = 0;
  for (const auto& [a, b, c] : triangulate(teeth)) {
    const double twice = glm::cross(teeth[b] - teeth[a], teeth[c] - teeth[a]).z;
    ASSERT_GE(twice, 0) << "turned over";
    area += twice / 2;
  }
  // Whole numbers below 2^53, so nothing is rounded.
  EXPECT_EQ(area, 100.0 * (kCorners / 4) + 2.0 * (kCorners / 4));
  std::vector<glm::dvec3> tangled;
  for (std::int64_t i = 0; i < kCorners; ++i) tangled.emplace_back(i * 7919 % 1009, i * 104729 % 1013, 0);
  EXPECT_EQ(triangulate(tangled).size(), std::size_t(kCorners - 2));
}

}  // namespace
}  // namespace luciole
