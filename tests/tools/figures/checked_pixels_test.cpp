#include "tools/figures/checked_pixels.hpp"

#include <gtest/gtest.h>

namespace luciole::test {
namespace {

TEST(CheckedPixels, AreOneInEachCellAndThoseOfTheirSeed) {
  const glm::ivec2 size(48, 27);
  const CheckedPixels checked = chooseCheckedPixels(size, 40, 7);
  // Of 5 x 5 pixels each, those at the right and lower edge smaller.
  EXPECT_EQ(checked.side, 5);
  EXPECT_EQ(checked.cells, glm::ivec2(10, 6));
  ASSERT_EQ(checked.pixels.size(), 60u);
  for (int i = 0; i < 60; ++i) {
    EXPECT_EQ(checked.pixels[i] / 5, glm::ivec2(i % 10, i / 10));
    EXPECT_TRUE(glm::all(glm::lessThan(checked.pixels[i], size)));
  }
  EXPECT_EQ(chooseCheckedPixels(size, 40, 7).pixels, checked.pixels);
  EXPECT_NE(chooseCheckedPixels(size, 40, 8).pixels, checked.pixels);
}

TEST(CheckedPixels, AreAllWhereMoreAreAskedForThanThereAre) {
  EXPECT_EQ(chooseCheckedPixels({8, 4}, 1000, 0).pixels.size(), 32u);
}

}  // namespace
}  // namespace luciole::test
