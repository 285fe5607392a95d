#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "kernels/probe.hpp"

// The functions of kernels/math.clh over their whole ranges, for the test that holds each to the error it
// states and for the benchmark that prints error beside cost.
namespace luciole::test {

inline constexpr float kLargest = std::numeric_limits<float>::max();
inline constexpr float kSmallestNormal = std::numeric_limits<float>::min();
inline constexpr float kSmallest = std::numeric_limits<float>::denorm_min();
inline constexpr float kBelowOne = 1 - 0x1p-24f;

/// Distance of the floats around `exact`.
inline double ulp(double exact) {
  const int exponent = std::max(std::ilogb(exact), -126);
  return std::ldexp(1.0, exponent - 23);
}

/// About `count` floats between two positive ones, evenly spread over their bit patterns, both ends included:
/// as dense in every binade.
inline Column sweep(float low, float high, std::uint32_t count) {
  const auto from = std::bit_cast<std::uint32_t>(low), to = std::bit_cast<std::uint32_t>(high);
  const std::uint32_t step =
      std::max<std::uint32_t>((to - from) / count, 1) | 1;  // odd: reaches all low bits
  Column values;
  for (std::uint64_t bits = from; bits < to; bits += step)
    values.push_back(std::bit_cast<float>(static_cast<std::uint32_t>(bits)));
  values.push_back(high);
  return values;
}

inline void append(Column& column, const Column& more) {
  column.insert(column.end(), more.begin(), more.end());
}

inline Column negated(Column column) {
  for (float& value : column) value = -value;
  return column;
}

struct MathFunction {
  const char* kernel;  ///< of math_probe.cl
  std::size_t outputs;
  std::vector<Column> in;  ///< a column for each argument, over the whole range
  double (*exact)(const double* arguments, std::size_t output);
};

inline MathFunction rsqrtFunction() {
  return {"probe_rsqrt", 1, {sweep(2 * kSmallestNormal, kLargest, 300000)}, [](const double* x, std::size_t) {
            return 1 / std::sqrt(x[0]);
          }};
}

inline MathFunction sqrtFunction() {
  return {"probe_sqrt", 1, {sweep(2 * kSmallestNormal, kLargest, 300000)}, [](const double* x, std::size_t) {
            return std::sqrt(x[0]);
          }};
}

/// Vectors of every length in range, in directions that lie as often near an axis or a plane as anywhere.
inline MathFunction normalizeFunction() {
  MathFunction function{
      "probe_normalize", 3, std::vector<Column>(3),
      [](const double* v, std::size_t output) { return v[output] / std::hypot(v[0], v[1], v[2]); }};
  const Column lengths = sweep(0x1p-50f, 0x1p63f, 60000);
  std::uint32_t bits = 1;
  const auto random = [&bits] { return float((bits = bits * 1664525u + 1013904223u) >> 8) / 0x1p23f - 1; };
  for (const float length : lengths) {
    float v[3] = {random(), random(), random()};
    for (float& component : v)
      if (random() > 0.5f) component = std::ldexp(component, int(20 * random()) - 20);
    const float scale = length / std::hypot(v[0], v[1], v[2]);
    if (!std::isfinite(scale)) continue;
    for (int c = 0; c < 3; ++c) function.in[c].push_back(v[c] * scale);
  }
  return function;
}

/// 2^(a·b) for products over the whole range, near every half integer too, where the polynomial's ends are;
/// and for factors that make such products of the largest and the smallest, as a power of a lobe does.
inline MathFunction exp2ProductFunction() {
  Column x = sweep(1e-12f, 127.0f, 150000);
  append(x, negated(sweep(1e-12f, 125.49999f, 150000)));
  append(x, sweep(0.0625f, 0.5f, 100000));
  append(x, negated(sweep(0.0625f, 0.5f, 100000)));
  for (int n = -125; n < 127; ++n)
    append(x, {n + 0.5f, std::nextafter(n + 0.5f, 200.0f), std::nextafter(n + 0.5f, -200.0f)});
  MathFunction function{"probe_exp2_product", 1, std::vector<Column>(2),
                        [](const double* a, std::size_t) { return std::exp2(a[0] * a[1]); }};
  constexpr std::array<float, 5> kFactors{1, 3, 0.7f, 123457, 1.1e-6f};
  for (std::size_t i = 0; i < x.size(); ++i) {
    const float factor = kFactors[i % kFactors.size()], other = x[i] / factor;
    const double product = double(factor) * other;
    if (product <= -125.5 || product > 127) continue;
    function.in[0].push_back(factor);
    function.in[1].push_back(other);
  }
  return function;
}

/// exp where exp2_product gives more than 0, x ≤ 0 as fog has it.
inline MathFunction expFunction() {
  return {"probe_exp", 1, {negated(sweep(1e-12f, 86.9f, 400000))}, [](const double* a, std::size_t) {
            return std::exp(a[0]);
          }};
}

inline MathFunction log2OnePlusFunction() {
  Column f = sweep(kSmallestNormal, 0x1p-8f, 50000);
  append(f, sweep(0x1p-8f, kBelowOne, 400000));
  return {"probe_log2_one_plus", 1, {negated(f)}, [](const double* a, std::size_t) {
            return std::log1p(a[0]) / std::log(2.0);
          }};
}

/// log2 of (1 + f)^n.
inline double exponentOf(double f, double n) { return n * std::log1p(f) / std::log(2.0); }

/// (1 + f)^n where it is above 2^-125.5, and not so near that a rounding of the exponent crosses the border.
inline MathFunction powOnePlusFunction() {
  MathFunction function{"probe_pow_one_plus", 1, std::vector<Column>(2),
                        [](const double* a, std::size_t) { return std::exp2(exponentOf(a[0], a[1])); }};
  for (const float n : {1e-6f, 0.1f, 1.0f, 2.0f, 32.0f, 128.0f, 1e4f, 1e6f}) {
    for (const float f : negated(sweep(5e-13f, kBelowOne, 40000))) {
      if (exponentOf(f, n) < -125.499) continue;
      function.in[0].push_back(f);
      function.in[1].push_back(n);
    }
  }
  return function;
}

struct MathErrors {
  double max_ulp = 0, mean_ulp = 0, max_relative = 0, max_absolute = 0;
};

/// -D options for these degrees.
inline std::string degreeDefines(int log2, int exp2) {
  return fmt::format("-DLOG2_DEGREE={} -DEXP2_DEGREE={} ", log2, exp2);
}

/// Calls `use(arguments, result, exact)` for every result that the device gives.
template <class Use>
void forEachResult(OpenedDevice& device, const MathFunction& function, const std::string& defines,
                   Use&& use) {
  const auto out =
      probe(device, "math_probe.cl", function.kernel, function.in, function.outputs, {}, defines);
  for (std::size_t i = 0; i < function.in[0].size(); ++i) {
    double arguments[3] = {};
    for (std::size_t a = 0; a < function.in.size(); ++a) arguments[a] = function.in[a][i];
    for (std::size_t o = 0; o < function.outputs; ++o)
      use(arguments, out[o][i], function.exact(arguments, o));
  }
}

inline MathErrors measureErrors(OpenedDevice& device, const MathFunction& function,
                                const std::string& defines) {
  MathErrors errors;
  std::size_t count = 0;
  forEachResult(device, function, defines, [&](const double*, float result, double exact) {
    // Components below the normal numbers may be flushed; none else is.
    if (std::abs(exact) < kSmallestNormal) return;
    const double error =
        std::isnan(result) ? std::numeric_limits<double>::infinity() : std::abs(result - exact);
    errors.max_absolute = std::max(errors.max_absolute, error);
    errors.max_relative = std::max(errors.max_relative, error / std::abs(exact));
    errors.max_ulp = std::max(errors.max_ulp, error / ulp(exact));
    errors.mean_ulp += error / ulp(exact);
    ++count;
  });
  errors.mean_ulp /= double(count);
  return errors;
}

}  // namespace luciole::test
