#include "tools/figures/rounds.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace luciole::test {
namespace {

using testing::ElementsAre;

TEST(Rounds, EveryRowRunsOnceARoundAndEachRoundBeginsWithAnother) {
  std::vector<std::size_t> order, told;
  const auto rounds = runInRounds(
      3, 3, "what", [&](const std::string&, std::size_t done, std::size_t) { told.push_back(done); },
      [&](std::size_t row) {
        order.push_back(row);
        return std::vector{double(order.size()), 10.0 * double(row)};
      });
  EXPECT_THAT(order, ElementsAre(0, 1, 2, 1, 2, 0, 2, 0, 1));
  EXPECT_THAT(told, ElementsAre(0, 1, 2, 3, 4, 5, 6, 7, 8));
  ASSERT_EQ(rounds.size(), 3u);
  EXPECT_THAT(rounds[0].figures[0], ElementsAre(1, 6, 8));
  EXPECT_THAT(rounds[2].figures[1], ElementsAre(20, 20, 20));
  EXPECT_EQ(rounds[1].summary(0).median, 4);
}

}  // namespace
}  // namespace luciole::test
