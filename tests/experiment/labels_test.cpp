#include "experiment/labels.hpp"

#include <gtest/gtest.h>

namespace luciole::test {
namespace {

const Rectangle kArea{{0, 0}, {600, 300}};

bool isInside(const Rectangle& a) {
  return a.low.x >= 0 && a.low.y >= 0 && a.high.x <= kArea.high.x && a.high.y <= kArea.high.y;
}

TEST(PlaceLabels, CrowdedPointsGetTextsThatOverlapNothing) {
  const std::vector<glm::dvec2> points{{100, 100}, {104, 100}, {108, 101}, {112, 99},
                                       {5, 5},     {595, 295}, {300, 1}};
  const std::vector<std::string> texts(points.size(), "lanes 16, log2 8");
  const Rectangle line{{0, 90}, {600, 92}};
  const std::vector<Rectangle> labels = placeLabels(points, texts, {line}, kArea);
  ASSERT_EQ(labels.size(), points.size());
  for (std::size_t i = 0; i < labels.size(); ++i) {
    EXPECT_TRUE(isInside(labels[i])) << i;
    EXPECT_FALSE(overlap(labels[i], line)) << i;
    for (std::size_t j = 0; j < i; ++j) EXPECT_FALSE(overlap(labels[i], labels[j])) << i << " and " << j;
    for (const glm::dvec2& point : points) EXPECT_FALSE(overlap(labels[i], {point - 1.0, point + 1.0})) << i;
  }
}

TEST(PlaceLabels, ATextHasTheSizeOfItsCharactersAndLiesNearItsPoint) {
  const glm::dvec2 point(300, 150);
  const Rectangle label = placeLabels({point}, {"name"}, {}, kArea).front();
  // Corners of up to 512 pixels round by 2⁻⁴⁵ in each of some four operations.
  EXPECT_NEAR(glm::distance(label.high - label.low, textSize("name")), 0, 1e-12);
  EXPECT_LT(glm::distance(glm::clamp(point, label.low, label.high), point), 15);
}

TEST(PlaceLabels, WithoutRoomEveryTextStillHasAPlace) {
  const std::vector<glm::dvec2> points(4, {5, 5});
  EXPECT_EQ(placeLabels(points, {"one", "two", "three", "four"}, {}, {{0, 0}, {10, 10}}).size(), 4u);
}

}  // namespace
}  // namespace luciole::test
