#include "tools/bench/speed_table.hpp"

#include <gtest/gtest.h>

namespace luciole::test {
namespace {

TEST(SpeedTable, ARatioIsTakenRoundByRound) {
  const Repeated taken = std::get<Repeated>(ratio({10, 20, 300}, {5, 10, 100}));
  EXPECT_EQ(taken.median, 2);
  EXPECT_EQ(taken.spread, 0.25);  // of 2, 2 and 3: quartiles 2 and 2.5
}

TEST(SpeedTable, OverNothingThereIsNoValueAndAReason) {
  EXPECT_EQ(std::get<double>(quotient(3, 2, "why")), 1.5);
  EXPECT_EQ(std::get<NoValue>(quotient(3, 0, "why")).why, "why");
  EXPECT_EQ(std::get<NoValue>(quotient(0, 0, "why")).why, "why");
  EXPECT_FALSE(std::get<NoValue>(ratio({1, 2}, {1, 0})).why.empty());
  EXPECT_FALSE(std::get<NoValue>(ratio({0}, {0})).why.empty());
}

}  // namespace
}  // namespace luciole::test
