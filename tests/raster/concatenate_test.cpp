#include "raster/concatenate.hpp"

#include <gtest/gtest.h>

namespace luciole::test {
namespace {

using Parts = std::vector<std::vector<int>>;

TEST(Concatenate, PartsFollowEachOther) {
  EXPECT_EQ(concatenate(Parts{{1, 2}, {}, {3}, {4, 5, 6}}), (std::vector{1, 2, 3, 4, 5, 6}));
}

TEST(Concatenate, OnePartIsAll) { EXPECT_EQ(concatenate(Parts{{7, 8}}), (std::vector{7, 8})); }

TEST(Concatenate, NoPartsAreNothing) { EXPECT_TRUE(concatenate(Parts{}).empty()); }

}  // namespace
}  // namespace luciole::test
