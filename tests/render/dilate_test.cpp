#include "render/dilate.hpp"

#include <gtest/gtest.h>

namespace luciole::test {
namespace {

/// One row of a channel.
Image row(std::vector<float> values) { return {int(values.size()), 1, {"R"}, std::move(values)}; }

TEST(Dilate, GrowsOutwardsAPixelATimeAndLeavesWhatIsThere) {
  Image image = row({0, 0, 0, 0, 2, 4, 0, 0});
  dilate(image, {0, 0, 0, 0, 1, 1, 0, 0}, 2);
  EXPECT_EQ(image.pixels, (std::vector<float>{0, 0, 2, 2, 2, 4, 4, 4}));
}

TEST(Dilate, MeansOfNeighboursMeetBetweenCharts) {
  Image image{3, 3, {"R"}, {1, 0, 3, 0, 0, 0, 5, 0, 7}};
  dilate(image, {1, 0, 1, 0, 0, 0, 1, 0, 1}, 1);
  EXPECT_EQ(image.pixels, (std::vector<float>{1, 2, 3, 3, 4, 5, 5, 6, 7}));
}

TEST(Dilate, NothingGrowsFromNothing) {
  Image image = row({0, 0, 0});
  dilate(image, {0, 0, 0}, 1000000);
  EXPECT_EQ(image.pixels, (std::vector<float>{0, 0, 0}));
}

}  // namespace
}  // namespace luciole::test
