#include "tools/figures/log_axis.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace luciole::test {
namespace {

using testing::ElementsAre;
using testing::SizeIs;

TEST(LogTicks, ArePowersOfTenOverDecadesAndFinerOverLess) {
  EXPECT_THAT(logTicks(0.5, 200), ElementsAre(1, 10, 100));
  EXPECT_THAT(logTicks(8, 120), ElementsAre(10, 30, 100));
  EXPECT_THAT(logTicks(18, 60), ElementsAre(20, 30, 50));
}

TEST(LogTicks, LieInsideTheRange) {
  for (const double low : {1.1e-7, 4e-3, 0.97, 1.0, 2.6, 31.0, 999.0, 1e4})
    for (const double ratio : {1.3, 2.0, 7.0, 1000.0}) {
      const std::vector<double> ticks = logTicks(low, low * ratio);
      EXPECT_GE(ticks.size(), 1u) << low << " " << ratio;
      for (const double tick : ticks) EXPECT_TRUE(tick >= low && tick <= low * ratio) << tick;
    }
}

TEST(LogTicks, SkipDecadesWhereThereAreTooMany) {
  EXPECT_THAT(logTicks(0.5, 2e6, 4), ElementsAre(1, 100, 1e4, 1e6));
  EXPECT_THAT(logTicks(1e-9, 2e9, 9), SizeIs(7));  // 19 powers, every third
}

TEST(LogAxis, EqualRatiosAreEqualDistances) {
  const LogAxis axis = axisAround({1, 10, 1000});
  EXPECT_LT(axis.low, 1);
  EXPECT_GT(axis.high, 1000);
  // Places are below 1 and come from some five roundings each.
  EXPECT_NEAR(axis.place(100) - axis.place(10), axis.place(1000) - axis.place(100), 1e-14);
  EXPECT_EQ(axis.place(axis.low / 2), 0);
  EXPECT_EQ(axis.place(axis.high * 2), 1);
  EXPECT_FALSE(axis.floor);
}

TEST(LogAxis, ZeroHasAPlaceBelowAllElse) {
  const LogAxis axis = axisAround({0, 1e-6, 1e-3});
  ASSERT_TRUE(axis.floor);
  EXPECT_LT(*axis.floor, 1e-6 / 2);
  EXPECT_GT(axis.place(0), 0);
  EXPECT_LT(axis.place(0), axis.place(1e-6));
}

TEST(LogAxis, OneValueOrNoneMakesAnAxis) {
  for (const std::vector<double>& values : {std::vector<double>{}, {0.0}, {7.0}, {7.0, 7.0}}) {
    const LogAxis axis = axisAround(values);
    EXPECT_GT(axis.low, 0);
    EXPECT_LT(axis.low, axis.high);
    EXPECT_FALSE(logTicks(axis.low, axis.high).empty());
  }
}

TEST(LogAxis, TicksAreReadable) {
  EXPECT_EQ(timeTick(0.01), "10 µs");
  EXPECT_EQ(timeTick(3), "3 ms");
  EXPECT_EQ(timeTick(1000), "1 s");
  EXPECT_EQ(timeTick(1e-7), "0.1 ns");
  EXPECT_EQ(countTick(1), "1");
  EXPECT_EQ(countTick(1000), "1k");
  EXPECT_EQ(countTick(30000), "30k");
  EXPECT_EQ(countTick(1e6), "1M");
  EXPECT_EQ(errorTick(0.01), "0.01");
  EXPECT_EQ(errorTick(30), "30");
  EXPECT_EQ(errorTick(1e-5), "10⁻⁵");
  EXPECT_EQ(errorTick(3e-10), "3·10⁻¹⁰");
  EXPECT_EQ(errorTick(1e4), "10⁴");
  // As logTicks makes them, rounded.
  for (int power = -12; power <= -3; ++power) {
    const std::string text =
        errorTick(logTicks(std::pow(10.0, power) * 0.9, std::pow(10.0, power) * 1.1, 1)[0]);
    EXPECT_EQ(text.find('e'), std::string::npos) << text;
  }
}

}  // namespace
}  // namespace luciole::test
