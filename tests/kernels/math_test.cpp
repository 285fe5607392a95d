#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "kernels/probe.hpp"

namespace luciole::test {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kLargest = std::numeric_limits<float>::max();
constexpr float kSmallestNormal = std::numeric_limits<float>::min();
constexpr float kSmallest = std::numeric_limits<float>::denorm_min();
const float kBelowOne = std::nextafter(1.0f, 0.0f);

/// Distance of neighbouring floats at `exact`.
double ulp(double exact) {
  const int exponent = std::max(std::ilogb(exact), -126);
  return std::ldexp(1.0, exponent - 23);
}

/// About `count` floats between two positive ones, evenly spread over their bit patterns, both ends included:
/// as dense in every binade.
Column sweep(float low, float high, std::uint32_t count) {
  const auto from = std::bit_cast<std::uint32_t>(low), to = std::bit_cast<std::uint32_t>(high);
  const std::uint32_t step =
      std::max<std::uint32_t>((to - from) / count, 1) | 1;  // odd: reaches all low bits
  Column values;
  for (std::uint64_t bits = from; bits < to; bits += step)
    values.push_back(std::bit_cast<float>(static_cast<std::uint32_t>(bits)));
  values.push_back(high);
  return values;
}

void append(Column& column, const Column& more) { column.insert(column.end(), more.begin(), more.end()); }

Column negated(Column column) {
  for (float& value : column) value = -value;
  return column;
}

Column run(int lanes, const char* kernel, const std::vector<Column>& in) {
  return probe(deviceWithLanes(lanes), "math_probe.cl", kernel, in, 1)[0];
}

TEST(MathKernels, ReciprocalRoot) {
  const Column x = sweep(2 * kSmallestNormal, kLargest, 300000);
  for (const int lanes : kAllLanes) {
    const Column y = run(lanes, "probe_rsqrt", {x});
    double worst = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      const double exact = 1 / std::sqrt(double(x[i]));
      worst = std::max(worst, std::abs(y[i] - exact) / ulp(exact));
    }
    EXPECT_LE(worst, 3) << lanes << " lanes";
  }
}

TEST(MathKernels, ReciprocalRootOfAlmostNothingIsFinite) {
  const Column x{0.0f, kSmallest, std::nextafter(kSmallestNormal, 0.0f), kSmallestNormal,
                 1.5f * kSmallestNormal};
  for (const int lanes : kAllLanes) {
    for (const float y : run(lanes, "probe_rsqrt", {x})) {
      EXPECT_TRUE(std::isfinite(y)) << lanes << " lanes";
      EXPECT_GT(y, 1e18f) << lanes << " lanes";
    }
  }
}

TEST(MathKernels, PowerOfTwo) {
  Column x = sweep(1e-12f, 127.0f, 150000);
  append(x, negated(sweep(1e-12f, 126.0f, 150000)));
  for (int n = -126; n < 127; ++n)
    append(x, {n + 0.5f, std::nextafter(n + 0.5f, 200.0f), std::nextafter(n + 0.5f, -200.0f)});
  for (const int lanes : kAllLanes) {
    const Column y = run(lanes, "probe_exp2", {x});
    double worst = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      const double exact = std::exp2(double(x[i]));
      worst = std::max(worst, std::abs(y[i] - exact) / ulp(exact));
    }
    EXPECT_LE(worst, 2) << lanes << " lanes";
    const Column whole = run(lanes, "probe_exp2", {{0.0f, -0.0f, kSmallest, 1.0f, -1.0f, 127.0f, -126.0f}});
    EXPECT_EQ(whole, (Column{1, 1, 1, 2, 0.5f, 0x1p127f, 0x1p-126f})) << lanes << " lanes";
  }
}

TEST(MathKernels, PowerOfTwoIsZeroBelowTheNormals) {
  const Column x{std::nextafter(-126.0f, -200.0f), -126.5f, -127.0f, -150.0f, -1e9f, -kLargest, -kInfinity};
  for (const int lanes : kAllLanes)
    EXPECT_EQ(run(lanes, "probe_exp2", {x}), Column(x.size(), 0.0f)) << lanes << " lanes";
}

TEST(MathKernels, LogarithmOfOneMinus) {
  Column t = sweep(kSmallestNormal, 0x1p-8f, 50000);
  append(t, sweep(0x1p-8f, kBelowOne, 400000));
  for (const int lanes : kAllLanes) {
    const Column y = run(lanes, "probe_log2_one_minus", {t});
    double worst = 0;
    for (std::size_t i = 0; i < t.size(); ++i) {
      const double exact = std::log1p(-double(t[i])) / std::log(2.0);
      worst = std::max(worst, std::abs(y[i] - exact) / std::abs(exact));
    }
    EXPECT_LE(worst, std::ldexp(1.0, -22)) << lanes << " lanes";
    EXPECT_EQ(run(lanes, "probe_log2_one_minus", {{0.0f, kSmallest, 1.0f}}), (Column{0, 0, -1e9f}))
        << lanes << " lanes";
  }
}

TEST(MathKernels, PowerOfOneMinus) {
  Column t, n;
  for (const float exponent : {1e-6f, 0.1f, 1.0f, 2.0f, 32.0f, 128.0f, 1e4f, 1e6f}) {
    Column values = sweep(1e-12f, kBelowOne, 40000);
    append(t, values);
    n.resize(t.size(), exponent);
  }
  for (const int lanes : kAllLanes) {
    const Column y = run(lanes, "probe_pow_one_minus", {t, n});
    double worst = 0;  // as a share of the bound
    for (std::size_t i = 0; i < t.size(); ++i) {
      const double exponent = n[i] * std::log1p(-double(t[i])) / std::log(2.0);
      const double exact = std::exp2(exponent);
      if (exact < 2.0 * kSmallestNormal) {
        ASSERT_TRUE(y[i] >= 0 && y[i] < 4 * kSmallestNormal)
            << t[i] << "^" << n[i] << " at " << lanes << " lanes";
        continue;
      }
      const double bound = exact * -exponent * std::ldexp(1.0, -22) + 2 * ulp(exact);
      worst = std::max(worst, std::abs(y[i] - exact) / bound);
    }
    EXPECT_LE(worst, 1) << lanes << " lanes";
  }
}

TEST(MathKernels, PowerOfOneMinusAtItsEnds) {
  const Column t{0, 0, 0, 1, 1, 1, 1, 0.5f, kSmallest};
  const Column n{0, 1, 1e6f, 0, 1, 1e-6f, 1e6f, 0, 1e6f};
  for (const int lanes : kAllLanes)
    EXPECT_EQ(run(lanes, "probe_pow_one_minus", {t, n}), (Column{1, 1, 1, 1, 0, 0, 0, 1, 1}))
        << lanes << " lanes";
}

TEST(MathKernels, NothingButFiniteColoursLeave) {
  const Column c{0, 1, 0x1p100f, kLargest, kInfinity, kNaN, -kNaN};
  for (const int lanes : kAllLanes)
    EXPECT_EQ(run(lanes, "probe_finite_color", {c}),
              (Column{0, 1, 0x1p100f, kLargest, kLargest, kLargest, kLargest}))
        << lanes << " lanes";
}

TEST(MathKernels, ClampAndExtremes) {
  const Column a{-kInfinity, -1, -0.0f, 0, 0.25f, 1, kBelowOne, 1.5f, kInfinity};
  const Column b{0, -2, 1, -1, 0.25f, 2, 1, 1, 0};
  for (const int lanes : kAllLanes) {
    EXPECT_EQ(run(lanes, "probe_clamp01", {a}), (Column{0, 0, 0, 0, 0.25f, 1, kBelowOne, 1, 1}))
        << lanes << " lanes";
    // A cosine that could not be told is no light.
    EXPECT_EQ(run(lanes, "probe_clamp01", {{kNaN}}), Column{0}) << lanes << " lanes";
    Column most, least;
    for (std::size_t i = 0; i < a.size(); ++i) {
      most.push_back(std::max(a[i], b[i]));
      least.push_back(std::min(a[i], b[i]));
    }
    EXPECT_EQ(run(lanes, "probe_max", {a, b}), most) << lanes << " lanes";
    EXPECT_EQ(run(lanes, "probe_min", {a, b}), least) << lanes << " lanes";
  }
}

TEST(MathKernels, AnyLaneSeesEveryLane) {
  for (const int lanes : kAllLanes) {
    // Row i has lane i set alone; the last row none.
    Column values((lanes + 1) * lanes, 0.0f), expected(values.size(), 1.0f);
    for (int lane = 0; lane < lanes; ++lane) values[lane * lanes + lane] = 1;
    for (int lane = 0; lane < lanes; ++lane) expected[lanes * lanes + lane] = 0;
    EXPECT_EQ(run(lanes, "probe_any_lane", {values}), expected) << lanes << " lanes";
  }
}

}  // namespace
}  // namespace luciole::test
