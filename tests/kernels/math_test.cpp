#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "gbuffer/packed_normal.hpp"
#include "kernels/math_functions.hpp"
#include "luciole/error.hpp"
#include "single_precision.hpp"

namespace luciole::test {
namespace {

// With what only some compilers have, and as a device without compiles them.
constexpr const char* kDialects[] = {"", "-DSTANDARD_ONLY=1 "};

/// Degrees of the two polynomials, and the largest relative errors that kernels/math.clh states for them.
struct Degrees {
  int log2, exp2;
  double log2_error, exp2_error;
};
const Degrees kUsual{7, 6, std::exp2(-21.0), 3 * kUnit};
const Degrees kOthers[] = {
    {3, 2, std::exp2(-11.4), std::exp2(-8.7)},  {4, 3, std::exp2(-14.2), std::exp2(-11.1)},
    {5, 4, std::exp2(-17.0), std::exp2(-18.0)}, {6, 5, std::exp2(-19.5), std::exp2(-20.6)},
    {8, 5, std::exp2(-21.1), std::exp2(-20.6)}, {9, 7, std::exp2(-21.6), std::exp2(-22.4)}};

/// Calls `check(device, degrees, defines)` for the usual degrees at every width and in both dialects,
/// and for the others with the extremes.
template <class Check>
void forEachProgram(Check&& check) {
  for (const int lanes : kAllLanes) {
    for (const char* dialect : kDialects) {
      SCOPED_TRACE(fmt::format("{} lanes {}", lanes, dialect));
      check(deviceWithLanes(lanes), kUsual, dialect);
    }
  }
  for (const Degrees& others : kOthers) {
    const std::string defines = degreeDefines(others.log2, others.exp2);
    for (const int lanes : lanesFor(defines)) {
      SCOPED_TRACE(fmt::format("{} lanes {}", lanes, defines));
      check(deviceWithLanes(lanes), others, defines);
    }
  }
}

Column run(int lanes, const char* kernel, const std::vector<Column>& in) {
  return probe(deviceWithLanes(lanes), "math_probe.cl", kernel, in, 1)[0];
}

TEST(MathKernels, ReciprocalRootAndRoot) {
  const MathFunction rsqrt = rsqrtFunction(), sqrt = sqrtFunction();
  for (const int lanes : kAllLanes) {
    for (const char* dialect : kDialects) {
      EXPECT_LE(measureErrors(deviceWithLanes(lanes), rsqrt, dialect).max_ulp, 1.5) << lanes << dialect;
      EXPECT_LE(measureErrors(deviceWithLanes(lanes), sqrt, dialect).max_ulp, 3) << lanes << dialect;
    }
    EXPECT_EQ(run(lanes, "probe_sqrt", {{0}}), Column{0}) << lanes << " lanes";
  }
}

TEST(MathKernels, ReciprocalRootOfAlmostNothingIsFiniteAndOfInfinityInfinite) {
  const Column x{0.0f, kSmallest, std::nextafter(kSmallestNormal, 0.0f), kSmallestNormal,
                 1.5f * kSmallestNormal};
  for (const int lanes : kAllLanes) {
    for (const float y : run(lanes, "probe_rsqrt", {x})) {
      EXPECT_TRUE(std::isfinite(y)) << lanes << " lanes";
      EXPECT_GT(y, 1e18f) << lanes << " lanes";
    }
    EXPECT_EQ(run(lanes, "probe_rsqrt", {{kInfinity}}), Column{kInfinity}) << lanes << " lanes";
  }
}

TEST(MathKernels, UnitVectors) {
  const MathFunction normalize = normalizeFunction();
  for (const int lanes : kAllLanes) {
    for (const char* dialect : kDialects) {
      const auto out =
          probe(deviceWithLanes(lanes), "math_probe.cl", normalize.kernel, normalize.in, 3, {}, dialect);
      double length_error = 0, angle = 0;
      for (std::size_t i = 0; i < out[0].size(); ++i) {
        const glm::dvec3 v(normalize.in[0][i], normalize.in[1][i], normalize.in[2][i]);
        const glm::dvec3 unit(out[0][i], out[1][i], out[2][i]);
        length_error = std::max(length_error, std::abs(glm::length(unit) - 1));
        angle = std::max(angle, glm::length(glm::cross(unit, v)) / glm::length(v) / glm::length(unit));
      }
      // The square of the length has 3 roundings in a row, which its root halves; the reciprocal root's 1.3
      // ulp are below 1.7 roundings, and the scaling rounds once more. Only the scaling treats the components
      // differently.
      EXPECT_LE(length_error, 4.2 * kUnit) << lanes << dialect;
      EXPECT_LE(angle, 1.001 * kUnit) << lanes << dialect;
    }
    EXPECT_EQ(probe(deviceWithLanes(lanes), "math_probe.cl", "probe_normalize", {{0}, {0}, {0}}, 3),
              (std::vector<Column>{{0}, {0}, {0}}))
        << lanes << " lanes";
  }
}

// a² is 1 + 2^-22 and 2^-46 more, which no float holds.
TEST(MathKernels, OnlyWhatSaysSoFusesAProductAndASum) {
  const float a = 1 + 0x1p-23f, rounded = 1 + 0x1p-22f;
  for (const int lanes : kAllLanes) {
    for (const char* dialect : kDialects) {
      const auto of = [&](const char* kernel) {
        return probe(deviceWithLanes(lanes), "math_probe.cl", kernel, {{a}, {a}, {-rounded}}, 1, {},
                     dialect)[0];
      };
      EXPECT_EQ(of("probe_fma"), Column{0x1p-46f}) << lanes << dialect;
      EXPECT_EQ(of("probe_product_and_sum"), Column{0}) << lanes << dialect;
    }
  }
}

TEST(MathKernels, UnpackedNormalsAreTheHosts) {
  // Of steps on both halves of the octahedron, in every quadrant, on its edges, folds and corners.
  std::vector<std::uint32_t> packed;
  const int steps[] = {-kPackedNormalSteps,
                       -32766,
                       -20000,
                       -16384,
                       -16383,
                       -12345,
                       -1,
                       0,
                       1,
                       12345,
                       16383,
                       16384,
                       20000,
                       32766,
                       kPackedNormalSteps,
                       7};
  for (const int y : steps)
    for (const int x : steps) packed.push_back(std::uint32_t(x & 0xffff) | std::uint32_t(y) << 16);
  for (const int lanes : kAllLanes) {
    const auto out = probe(deviceWithLanes(lanes), "math_probe.cl", "probe_unpack_normal",
                           {Column(packed.size())}, 3, {{"packed", packed}});
    double difference = 0;
    for (std::size_t i = 0; i < packed.size(); ++i)
      difference = std::max(
          difference, glm::length(glm::dvec3(out[0][i], out[1][i], out[2][i]) - unpackNormal(packed[i])));
    // Whole numbers until it is made unit: what UnitVectors allows of length and angle.
    EXPECT_LE(difference, 4.4 * kUnit) << lanes << " lanes";
  }
}

TEST(MathKernels, PowerOfTwoAtEveryDegree) {
  const MathFunction exp2 = exp2ProductFunction();
  forEachProgram([&](OpenedDevice& device, const Degrees& degrees, const std::string& defines) {
    double worst = 0, worst_ulp = 0;  // as a share of the bound
    forEachResult(device, exp2, defines, [&](const double*, float result, double exact) {
      const double error = std::abs(result - exact);
      worst = std::max(worst, error / exact / degrees.exp2_error);
      worst_ulp = std::max(worst_ulp, error / ulp(exact));
    });
    EXPECT_LE(worst, 1);
    if (degrees.exp2 == kUsual.exp2) {
      EXPECT_LE(worst_ulp, 1.9);
    }
    const Column a{0.0f, -0.0f, kSmallest, -kSmallest, 1.0f, 0.5f, 127.0f, -25.0f, 0.0f, kLargest};
    const Column b{1.0f, 5.0f, 1.0f, 1.0f, 1.0f, -2.0f, 1.0f, 5.0f, kLargest, 0.0f};
    EXPECT_EQ(probe(device, "math_probe.cl", "probe_exp2_product", {a, b}, 1, {}, defines)[0],
              (Column{1, 1, 1, 1, 2, 0.5f, 0x1p127f, 0x1p-125f, 1, 1}));
  });
}

TEST(MathKernels, PowersBelowTheBorderAreZero) {
  const Column b{-125.5f, -126.5f, -127.0f, -150.0f, -1e9f, -kLargest, -kInfinity};
  const Column one(b.size(), 1.0f);
  Column x;  // for e^x
  for (const float value : b) x.push_back(value * 0.694f);
  for (const int lanes : kAllLanes) {
    EXPECT_EQ(run(lanes, "probe_exp2_product", {one, b}), Column(b.size(), 0.0f)) << lanes << " lanes";
    EXPECT_EQ(run(lanes, "probe_exp", {x}), Column(b.size(), 0.0f)) << lanes << " lanes";
    EXPECT_EQ(run(lanes, "probe_exp2_product", {{kNaN, 1, kInfinity, kInfinity}, {1, kNaN, 0, -1}}),
              Column(4, 0.0f))
        << lanes << " lanes";
  }
}

TEST(MathKernels, ExponentialAtEveryDegree) {
  const MathFunction exp = expFunction();
  forEachProgram([&](OpenedDevice& device, const Degrees& degrees, const std::string& defines) {
    double worst = 0, worst_absolute = 0;  // as a share of the bound; of 1
    forEachResult(device, exp, defines, [&](const double* x, float result, double exact) {
      const double error = std::abs(result - exact);
      // The constant log2(e) is off by 0.23 roundings, its product with x rounds at most once.
      worst = std::max(worst, error / exact / (0.23 * kUnit * -x[0] + degrees.exp2_error));
      worst_absolute = std::max(worst_absolute, error);
    });
    EXPECT_LE(worst, 1);
    if (degrees.exp2 == kUsual.exp2) {
      EXPECT_LE(worst_absolute, 3 * kUnit);
    }
    EXPECT_EQ(probe(device, "math_probe.cl", "probe_exp", {{0.0f, -0.0f, -kSmallest}}, 1, {}, defines)[0],
              (Column{1, 1, 1}));
  });
}

TEST(MathKernels, LogarithmOfOnePlusAtEveryDegree) {
  const MathFunction log2 = log2OnePlusFunction();
  forEachProgram([&](OpenedDevice& device, const Degrees& degrees, const std::string& defines) {
    const MathErrors errors = measureErrors(device, log2, defines);
    EXPECT_LE(errors.max_relative, degrees.log2_error);
    if (degrees.log2 == kUsual.log2) {
      EXPECT_LE(errors.max_ulp, 3.7);
    }
  });
}

TEST(MathKernels, LogarithmOfOnePlusAtItsEnds) {
  for (const int lanes : kAllLanes) {
    EXPECT_EQ(run(lanes, "probe_log2_one_plus", {{0.0f, -1.0f, -1.5f, -kLargest, -kInfinity, kNaN}}),
              (Column{0, -1e9f, -1e9f, -1e9f, -1e9f, -1e9f}))
        << lanes << " lanes";
    for (const float f : {-kSmallest, -std::nextafter(kSmallestNormal, 0.0f)}) {
      const float log2 = run(lanes, "probe_log2_one_plus", {{f}})[0];
      EXPECT_TRUE(log2 <= 0 && log2 >= 2 * f) << lanes << " lanes";
    }
    EXPECT_NEAR(run(lanes, "probe_log2_one_plus", {{-kBelowOne}})[0], -24, 24 * kUsual.log2_error);
  }
}

TEST(MathKernels, PowerOfOnePlusAtEveryDegree) {
  const MathFunction pow = powOnePlusFunction();
  forEachProgram([&](OpenedDevice& device, const Degrees& degrees, const std::string& defines) {
    double worst = 0, worst_absolute = 0;  // as a share of the bound; of 1
    forEachResult(device, pow, defines, [&](const double* a, float result, double exact) {
      // What the logarithm is off moves the exponent.
      const double moved = -exponentOf(a[0], a[1]) * degrees.log2_error;
      const double bound = std::exp2(moved) * (1 + degrees.exp2_error) - 1;
      worst = std::max(worst, std::abs(result - exact) / exact / bound);
      worst_absolute = std::max(worst_absolute, std::abs(result - exact));
    });
    EXPECT_LE(worst, 1);
    if (degrees.log2 == kUsual.log2) {
      EXPECT_LE(worst_absolute, 5 * kUnit);
    }
  });
}

TEST(MathKernels, PowerOfOnePlusAtItsEnds) {
  const Column f{0, 0, 0, 0, -1, -1, -1, -1, -1, -0.5, -kSmallest, -kBelowOne, -0.5f, -2, -kInfinity, kNaN};
  const Column n{0, 1, 1e6f, kLargest, 0, 1, 1e-6f, 1e6f, kLargest, 0, 1e6f, 1e6f, kInfinity, 1, 1, 1};
  for (const int lanes : kAllLanes)
    EXPECT_EQ(run(lanes, "probe_pow_one_plus", {f, n}),
              (Column{1, 1, 1, 1, 1, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 0}))
        << lanes << " lanes";
}

TEST(MathKernels, PowersBelowTheBorderNeverReturn) {
  Column f, n;
  for (const float exponent : {2.0f, 32.0f, 1e4f, 1e6f}) {
    for (const float value : negated(sweep(5e-7f, 1.0f, 40000))) {
      if (exponentOf(value, exponent) > -125.5) continue;
      f.push_back(value);
      n.push_back(exponent);
    }
  }
  // 2^-125.5, as pow_one_plus may have it wrong.
  constexpr double kBorder = 1.4142136 * 0x1p-126 * (1 + 126 * 5.6 * kUnit + 3 * kUnit);
  for (const int lanes : kAllLanes)
    for (const float y : run(lanes, "probe_pow_one_plus", {f, n}))
      ASSERT_TRUE(y == 0 || (y >= kSmallestNormal && y <= kBorder)) << y << ", " << lanes << " lanes";
}

TEST(MathKernels, DegreesThatAreNotThereAreRefused) {
  for (const auto& [log2, exp2] : {std::pair{7, 1}, {7, 8}, {2, 6}, {10, 6}})
    EXPECT_THROW(
        probe(deviceWithLanes(1), "math_probe.cl", "probe_exp", {{0}}, 1, {}, degreeDefines(log2, exp2)),
        MachineError);
}

TEST(MathKernels, NothingButFiniteColoursLeave) {
  const Column c{0, 1, 0x1p100f, kLargest, kInfinity, kNaN, -kNaN, -1, -kLargest, -kInfinity};
  for (const int lanes : kAllLanes)
    EXPECT_EQ(run(lanes, "probe_finite_color", {c}),
              (Column{0, 1, 0x1p100f, kLargest, kLargest, kLargest, kLargest, -1, -kLargest, -kLargest}))
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

// A row for each lane in which that one is the extreme.
TEST(MathKernels, FoldsOfARowSeeEveryLane) {
  for (const int lanes : kAllLanes) {
    for (const char* dialect : kDialects) {
      const auto of = [&](const char* kernel, const Column& in) {
        return probe(deviceWithLanes(lanes), "math_probe.cl", kernel, {in}, 1, {}, dialect)[0];
      };
      const std::size_t size = std::size_t(lanes) * lanes;
      Column low(size, 3.0f), high(size, -3.0f), least(size, -5.0f), most(size, 5.0f), bits;
      for (int lane = 0; lane < lanes; ++lane) {
        low[lane * lanes + lane] = -5;
        high[lane * lanes + lane] = 5;
        bits.insert(bits.end(), lanes, float(1 << lane));
      }
      EXPECT_EQ(of("probe_least_lane", low), least) << lanes << dialect;
      EXPECT_EQ(of("probe_smallest_lane", low), least) << lanes << dialect;
      EXPECT_EQ(of("probe_greatest_lane", high), most) << lanes << dialect;
      EXPECT_EQ(of("probe_largest_lane", high), most) << lanes << dialect;
      EXPECT_EQ(of("probe_lane_bits", low), bits) << lanes << dialect;
    }
  }
}

}  // namespace
}  // namespace luciole::test
