#include "raster/clip_polygon.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/glm.hpp>
#include <random>
#include <vector>

namespace luciole::test {
namespace {

using Flat = Polygon<glm::dvec2, 30>;

Flat polygonOf(const std::vector<glm::dvec2>& corners) {
  Flat polygon;
  for (const glm::dvec2& corner : corners) polygon.add(corner);
  return polygon;
}

std::vector<glm::dvec2> cornersOf(const Flat& polygon) {
  return {polygon.corners.begin(), polygon.corners.begin() + polygon.count};
}

/// What is left where normal · p ≥ limit.
Flat clipAt(const Flat& polygon, const glm::dvec2& normal, double limit) {
  Flat kept;
  clipPolygon(
      polygon, [&](const glm::dvec2& p) { return glm::dot(normal, p) - limit; }, edgeCrossing<glm::dvec2>,
      kept);
  return kept;
}

double twiceArea(const Flat& polygon) {
  double sum = 0;
  for (int i = 0; i < polygon.count; ++i) {
    const glm::dvec2 &a = polygon.corners[i], &b = polygon.corners[(i + 1) % polygon.count];
    sum += a.x * b.y - a.y * b.x;
  }
  return sum;
}

const std::vector<glm::dvec2> kSquare{{0, 0}, {4, 0}, {4, 4}, {0, 4}};

TEST(ClipPolygon, WhatIsInsideStaysAsItIs) {
  EXPECT_EQ(cornersOf(clipAt(polygonOf(kSquare), {1, 0}, -1)), kSquare);
}

TEST(ClipPolygon, OfWhatIsOutsideNothingIsLeft) { EXPECT_EQ(clipAt(polygonOf(kSquare), {1, 0}, 5).count, 0); }

TEST(ClipPolygon, NothingStaysNothing) { EXPECT_EQ(clipAt(Flat{}, {1, 0}, 0).count, 0); }

TEST(ClipPolygon, CornersOnThePlaneAreInsideAndTheirEdgesToTheOutsideAreCutThere) {
  EXPECT_EQ(cornersOf(clipAt(polygonOf(kSquare), {1, 0}, 4)),
            (std::vector<glm::dvec2>{{4, 0}, {4, 0}, {4, 4}, {4, 4}}));
}

TEST(ClipPolygon, CutEdgesGetNewCornersInTheOrderOfTheOldOnes) {
  EXPECT_EQ(cornersOf(clipAt(polygonOf(kSquare), {0, -1}, -1)),
            (std::vector<glm::dvec2>{{0, 1}, {0, 0}, {4, 0}, {4, 1}}));
}

TEST(ClipPolygon, TheEdgeFromTheLastToTheFirstCornerComesFirst) {
  EXPECT_EQ(cornersOf(clipAt(polygonOf(kSquare), {0, 1}, 3)),
            (std::vector<glm::dvec2>{{0, 3}, {4, 3}, {4, 4}, {0, 4}}));
}

TEST(ClipPolygon, CrossingsGetTheEndsOfTheirEdgeInItsDirection) {
  Flat kept;
  std::vector<glm::dvec4> calls;
  clipPolygon(
      polygonOf(kSquare), [](const glm::dvec2& p) { return p.x - 1; },
      [&](const glm::dvec2& a, double da, const glm::dvec2& b, double db) {
        calls.emplace_back(a.y, da, b.y, db);
        return a;
      },
      kept);
  EXPECT_EQ(calls, (std::vector<glm::dvec4>{{0, -1, 0, 3}, {4, 3, 4, -1}}));
}

TEST(ClipPolygon, BothSidesOfACutTogetherAreTheWhole) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> place(-1, 1);
  const auto point = [&] { return glm::dvec2(place(random), place(random)); };
  for (int i = 0; i < 2000; ++i) {
    const Flat whole = polygonOf({point(), point(), point()});
    const glm::dvec2 normal = point();
    const double limit = place(random);
    // Corners are at most 1 a coordinate, and new ones within 4 · 2⁻⁵³ of them; each of at most five products
    // of two coordinates a side errs by some 10 · 2⁻⁵³ so. A crossing whose distances nearly cancel lies
    // anywhere along an edge that runs along the cut, which adds no area.
    ASSERT_NEAR(twiceArea(clipAt(whole, normal, limit)) + twiceArea(clipAt(whole, -normal, -limit)),
                twiceArea(whole), 100 * 0x1p-53);
  }
}

TEST(ClipPolygon, CornersInAnyOrderBecomeHalfAsManyMoreAtMost) {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> place(-1, 1);
  int most = 0;
  for (int i = 0; i < 20000; ++i) {
    Flat polygon;
    for (int k = 0; k < 3 + i % 7; ++k) polygon.add({place(random), place(random)});
    const int left = clipAt(polygon, {place(random), place(random)}, 0.1 * place(random)).count;
    ASSERT_LE(left, 3 * polygon.count / 2);
    most = std::max(most, left - polygon.count);
  }
  EXPECT_EQ(most, 4);  // 8 or 9 corners, every other one inside
}

}  // namespace
}  // namespace luciole::test
