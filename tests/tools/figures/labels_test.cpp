#include "tools/figures/labels.hpp"

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
  const Rectangle box{{0, 150}, {600, 160}};
  const Segment level{{0, 91}, {600, 91}}, slope{{60, 200}, {140, 0}};
  std::vector<Label> labels;
  for (const glm::dvec2& point : points) labels.push_back({point, "lanes 16, log2 8"});
  const std::vector<LabelPlace> places = placeLabels(labels, 12, {box}, {level, slope}, kArea);
  ASSERT_EQ(places.size(), points.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Rectangle& text = places[i].text;
    EXPECT_TRUE(isInside(text)) << i;
    EXPECT_FALSE(overlap(text, box)) << i;
    EXPECT_FALSE(overlap(text, level)) << i;
    EXPECT_FALSE(overlap(text, slope)) << i;
    for (std::size_t j = 0; j < i; ++j) EXPECT_FALSE(overlap(text, places[j].text)) << i << " and " << j;
    for (const glm::dvec2& point : points)
      EXPECT_FALSE(overlap(text, Rectangle{point - 1.0, point + 1.0})) << i;
    for (std::size_t j = 0; j < places.size(); ++j)
      if (j != i && places[j].has_leader) {
        EXPECT_FALSE(overlap(text, places[j].leader)) << i << " and " << j;
      }
  }
}

TEST(PlaceLabels, ATextHasTheSizeOfItsCharactersAndLiesNearItsPoint) {
  const glm::dvec2 point(300, 150);
  const LabelPlace label = placeLabels({{point, "n·me"}}, 12, {}, {}, kArea).front();
  // Corners of up to 512 pixels round by 2⁻⁴⁵ in each of some four operations.
  EXPECT_NEAR(glm::distance(label.text.high - label.text.low, textSize("name", 12)), 0, 1e-12);
  EXPECT_LT(glm::distance(glm::clamp(point, label.text.low, label.text.high), point), 15);
  EXPECT_FALSE(label.has_leader);
}

TEST(PlaceLabels, WithoutRoomEveryTextStillHasAPlaceInside) {
  const std::vector<Label> labels(30, {{590, 5}, "one of thirty that lie at one point"});
  const std::vector<LabelPlace> places = placeLabels(labels, 12, {}, {}, {{0, 0}, {600, 100}});
  ASSERT_EQ(places.size(), 30u);
  for (const LabelPlace& place : places) EXPECT_TRUE(isInside(place.text));
}

TEST(Overlap, ALineIsOverWhatItGoesThrough) {
  const Rectangle box{{10, 10}, {20, 20}};
  for (const Segment& line : {Segment{{0, 15}, {30, 15}},
                              {{15, 15}, {15, 90}},
                              {{0, 0}, {30, 30}},
                              {{8, 16}, {14, 22}},
                              {{12, 12}, {13, 14}}}) {
    EXPECT_TRUE(overlap(box, line)) << line.from.x << " " << line.from.y;
    EXPECT_TRUE(overlap(box, Segment{line.to, line.from})) << line.from.x << " " << line.from.y;
  }
  for (const Segment& line : {Segment{{0, 9}, {30, 9}},
                              {{21, 0}, {21, 30}},
                              {{0, 18}, {12, 30}},
                              {{0, 15}, {9, 15}},
                              {{5, 0}, {5, 5}}}) {
    EXPECT_FALSE(overlap(box, line)) << line.from.x << " " << line.from.y;
    EXPECT_FALSE(overlap(box, Segment{line.to, line.from})) << line.from.x << " " << line.from.y;
  }
}

}  // namespace
}  // namespace luciole::test
