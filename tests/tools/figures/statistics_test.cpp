#include "tools/figures/statistics.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace luciole::test {
namespace {

TEST(Summarize, OneRunIsItsMedianWithoutSpread) {
  const Repeated timing = summarize({7});
  EXPECT_EQ(timing.median, 7);
  EXPECT_EQ(timing.spread, 0);
}

TEST(Summarize, MedianAndHalfTheQuartilesDistanceInAnyOrder) {
  const Repeated odd = summarize({50, 10, 40, 20, 30});
  EXPECT_EQ(odd.median, 30);
  EXPECT_EQ(odd.spread, 10);  // quartiles 20 and 40
  const Repeated even = summarize({4, 1, 3, 2});
  EXPECT_EQ(even.median, 2.5);
  EXPECT_EQ(even.spread, 0.75);  // quartiles 1.75 and 3.25
}

TEST(Summarize, OneRunThatWasDisturbedChangesNeither) {
  const Repeated calm = summarize({1, 2, 3, 4, 5}), disturbed = summarize({1, 2, 3, 4, 5000});
  EXPECT_EQ(calm.median, disturbed.median);
  EXPECT_EQ(calm.spread, disturbed.spread);
}

/// Times of rounds: `factor` times as long as `under`, within a share `noise`, while other work makes both
/// longer.
struct Rounds {
  std::vector<double> over, under;
};
Rounds madeUpRounds(int rounds, double factor, double noise, std::uint32_t bits = 1) {
  const auto random = [&] { return double((bits = bits * 1664525u + 1013904223u) >> 8) / (1 << 24); };
  Rounds made;
  for (int i = 0; i < rounds; ++i) {
    const double other_work = 1 + 4 * random();
    made.under.push_back(10 * other_work);
    made.over.push_back(10 * other_work * factor * (1 + noise * (2 * random() - 1)));
  }
  return made;
}

TEST(TimeRatio, IsThatOfTheRoundsWhateverElseTheMachineDoes) {
  const Rounds exact = madeUpRounds(9, 2.5, 0);
  const TimeRatio ratio = timeRatio(exact.over, exact.under).value();
  EXPECT_NEAR(ratio.median, 2.5, 1e-15);
  EXPECT_NEAR(ratio.low, 2.5, 1e-15);
  EXPECT_NEAR(ratio.high, 2.5, 1e-15);
}

TEST(TimeRatio, IntervalHoldsTheRatioOfTheRoundsAndLiesWithinThem) {
  for (std::uint32_t seed = 1; seed <= 50; ++seed) {
    const Rounds noisy = madeUpRounds(3 + int(seed % 9), 2, 0.3, seed);
    const TimeRatio ratio = timeRatio(noisy.over, noisy.under).value();
    EXPECT_LE(ratio.low, ratio.median) << seed;
    EXPECT_GE(ratio.high, ratio.median) << seed;
    EXPECT_LT(ratio.low, ratio.high) << seed;
    EXPECT_GE(ratio.low, 2 * 0.7 - 1e-9) << seed;
    EXPECT_LE(ratio.high, 2 * 1.3 + 1e-9) << seed;
  }
}

TEST(TimeRatio, IntervalHoldsTheTruthAboutAsOftenAsItSays) {
  int held = 0;
  for (std::uint32_t seed = 1; seed <= 400; ++seed) {
    const Rounds noisy = madeUpRounds(25, 2, 0.2, seed * 7919);
    const TimeRatio ratio = timeRatio(noisy.over, noisy.under).value();
    held += ratio.low <= 2 && 2 <= ratio.high;
  }
  // 380 are expected, with a standard deviation of 4.4; the bootstrap of a median holds for somewhat fewer.
  EXPECT_GE(held, 360);
  EXPECT_LE(held, 394);
}

TEST(TimeRatio, IntervalNarrowsWithTheRounds) {
  double width[3] = {};
  const int rounds[] = {5, 25, 125};
  for (std::uint32_t seed = 1; seed <= 20; ++seed)
    for (int i = 0; i < 3; ++i) {
      const Rounds noisy = madeUpRounds(rounds[i], 2, 0.2, seed * 7919);
      const TimeRatio ratio = timeRatio(noisy.over, noisy.under).value();
      width[i] += ratio.high - ratio.low;
    }
  // As the root of their number, or nearly.
  EXPECT_LT(width[1], width[0] / 1.5);
  EXPECT_LT(width[2], width[1] / 1.5);
}

TEST(TimeRatio, IsTheSameEachTime) {
  const Rounds noisy = madeUpRounds(9, 2, 0.3);
  const TimeRatio one = timeRatio(noisy.over, noisy.under).value(),
                  other = timeRatio(noisy.over, noisy.under).value();
  EXPECT_EQ(one.low, other.low);
  EXPECT_EQ(one.high, other.high);
}

TEST(TimeRatio, FewRoundsOrNoTimeTellNone) {
  EXPECT_FALSE(timeRatio({1, 2}, {1, 2}));
  EXPECT_FALSE(timeRatio({}, {}));
  EXPECT_FALSE(timeRatio({1, 2, 3}, {1, 0, 3}));
  EXPECT_FALSE(timeRatio({0, 2, 3}, {1, 2, 3}));
  EXPECT_TRUE(timeRatio({1, 2, 3}, {1, 2, 3}));
}

TEST(PrintedError, HasTwoDigits) {
  EXPECT_EQ(printedError(0.0012345), 0.0012);
  EXPECT_EQ(printedError(9.96e-5), printedError(1.0e-4));
  EXPECT_EQ(printedError(0), 0);
}

using Rows = std::vector<SpeedAndError>;
using Front = std::vector<bool>;

TEST(ParetoFront, HoldsWhatIsFasterOrNearerThanAllOthers) {
  const Rows rows{{{10, 0}, 1}, {{20, 0}, 0.5}, {{30, 0}, 0.7}, {{5, 0}, 2}, {{40, 0}, 0.1}};
  EXPECT_EQ(paretoFront(rows), (Front{true, true, false, true, true}));
}

TEST(ParetoFront, HoldsTheOnlyRowAndBothOfTwoEqualOnes) {
  EXPECT_EQ(paretoFront({}), Front{});
  EXPECT_EQ(paretoFront({{{10, 1}, 0}}), Front{true});
  EXPECT_EQ(paretoFront({{{10, 0}, 1}, {{10, 0}, 1}}), (Front{true, true}));
}

TEST(ParetoFront, NoiseInTimeBeatsNoRow) {
  // Equally wrong and apart by no more than both spreads: neither is known to be faster.
  EXPECT_EQ(paretoFront({{{10, 1}, 1}, {{12, 1}, 1}}), (Front{true, true}));
  EXPECT_EQ(paretoFront({{{10, 1}, 1}, {{12.5, 1}, 1}}), (Front{true, false}));
}

TEST(ParetoFront, ANearerRowBeatsOneThatIsOnlyFasterByNoise) {
  EXPECT_EQ(paretoFront({{{10, 1}, 1}, {{12, 1}, 0.5}}), (Front{false, true}));
  EXPECT_EQ(paretoFront({{{10, 1}, 1}, {{12.5, 1}, 0.5}}), (Front{true, true}));
}

TEST(ParetoFront, ErrorsThatPrintAlikeAreEqual) {
  EXPECT_EQ(paretoFront({{{10, 0}, 1.201e-6}, {{20, 0}, 1.199e-6}}), (Front{true, false}));
}

TEST(ParetoFront, IsNeverEmptyHoweverTheRowsOverlap) {
  // Spreads so wide that being beaten isn't transitive: a chain in time that bites its tail if errors didn't
  // break it.
  std::uint32_t bits = 1;
  const auto random = [&] { return double((bits = bits * 1664525u + 1013904223u) >> 8) / (1 << 24); };
  for (int trial = 0; trial < 1000; ++trial) {
    Rows rows;
    for (int i = 0; i < 6; ++i)
      rows.push_back({{10 + 5 * random(), 2 * random()}, 0.1 * std::floor(3 * random())});
    const Front front = paretoFront(rows);
    EXPECT_NE(std::count(front.begin(), front.end(), true), 0) << trial;
  }
}

}  // namespace
}  // namespace luciole::test
