#include "tools/figures/growth.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace luciole {
namespace {

/// The best a and b for an exponent, and the sum of squares of the relative residuals.
struct LinearFit {
  double a = 0, b = 0, error = 0;
};

double errorOf(const std::vector<double>& powers, const std::vector<double>& times, double a, double b) {
  double sum = 0;
  for (std::size_t i = 0; i < times.size(); ++i) {
    const double residual = (a + b * powers[i]) / times[i] - 1;
    sum += residual * residual;
  }
  return sum;
}

/// Least squares with a, b ≥ 0. The sum is convex: if a or b is negative at the unconstrained minimum, it is
/// 0 at the constrained one.
LinearFit fitLinear(const std::vector<double>& powers, const std::vector<double>& times) {
  // Dividing by the time t makes residuals relative: the columns are 1/t and p/t, the right-hand side is 1.
  double aa = 0, ab = 0, bb = 0, a1 = 0, b1 = 0;
  for (std::size_t i = 0; i < times.size(); ++i) {
    const double u = 1 / times[i], v = powers[i] / times[i];
    aa += u * u;
    ab += u * v;
    bb += v * v;
    a1 += u;
    b1 += v;
  }
  const double determinant = aa * bb - ab * ab;
  std::vector<LinearFit> candidates{{a1 / aa, 0}, {0, b1 / bb}};
  if (determinant > 0) {
    const double a = (a1 * bb - b1 * ab) / determinant, b = (b1 * aa - a1 * ab) / determinant;
    if (a >= 0 && b >= 0) candidates.push_back({a, b});
  }
  for (LinearFit& fit : candidates) fit.error = errorOf(powers, times, fit.a, fit.b);
  return *std::min_element(candidates.begin(), candidates.end(),
                           [](const LinearFit& x, const LinearFit& y) { return x.error < y.error; });
}

/// The best fit for the exponent c. Powers are scaled so that the largest is 1: the squares of (10⁶)³ would
/// leave no digits for the other terms.
LinearFit fitExponent(const std::vector<double>& lights, const std::vector<double>& times, double c) {
  const double most = *std::max_element(lights.begin(), lights.end());
  std::vector<double> powers;
  for (const double n : lights) powers.push_back(std::pow(n / most, c));
  LinearFit fit = fitLinear(powers, times);
  fit.b /= std::pow(most, c);
  return fit;
}

/// The 97.5 % point of Student's distribution, by degrees of freedom: a table's first rows, then the
/// expansion of Abramowitz and Stegun 26.7.5 to the second term, which from 11 on is right to 0.002.
double studentQuantile(std::size_t freedom) {
  constexpr double kTable[] = {12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228};
  if (freedom <= std::size(kTable)) return kTable[freedom - 1];
  constexpr double z = 1.959964;
  const double n = double(freedom);
  return z + (z * z * z + z) / (4 * n) + (5 * std::pow(z, 5) + 16 * z * z * z + 3 * z) / (96 * n * n);
}

constexpr double kStep = 1.0 / 64;     ///< between exponents that are tried first
constexpr double kPrecision = 1e-6;    ///< of the exponent and its interval
constexpr double kRounding = 0x1p-40;  ///< of a sum of squares: what is smaller is no residual

/// The exponent between two at which `inside` changes from true to false.
template <class Inside>
double findEdge(double in, double out, Inside&& inside) {
  while (std::abs(out - in) > kPrecision) {
    const double middle = (in + out) / 2;
    (inside(middle) ? in : out) = middle;
  }
  return (in + out) / 2;
}

/// The minimum of a function that has one between low and high, by golden sections.
template <class Function>
double findMinimum(double low, double high, Function&& value) {
  const double share = (std::sqrt(5.0) - 1) / 2;
  double left = high - share * (high - low), right = low + share * (high - low);
  double at_left = value(left), at_right = value(right);
  while (high - low > kPrecision) {
    if (at_left < at_right) {
      high = right;
      right = left;
      at_right = at_left;
      at_left = value(left = high - share * (high - low));
    } else {
      low = left;
      left = right;
      at_left = at_right;
      at_right = value(right = low + share * (high - low));
    }
  }
  return (low + high) / 2;
}

}  // namespace

Growth fitGrowth(const std::vector<double>& lights, const std::vector<double>& milliseconds) {
  const std::size_t points = lights.size();
  if (points < std::size_t(kFewestCounts))
    return {{}, fmt::format("too few numbers of lights: {} of {}", points, kFewestCounts)};
  const auto error = [&](double c) { return fitExponent(lights, milliseconds, c).error; };
  double best = 0, least = error(0);
  for (double c = kStep; c <= kSteepest; c += kStep)
    if (const double e = error(c); e < least) {
      best = c;
      least = e;
    }
  if (best > 0) best = findMinimum(std::max(best - kStep, 0.0), std::min(best + kStep, kSteepest), error);
  least = std::max(error(best), kRounding * double(points));
  const std::size_t freedom = points - 3;
  const double t = studentQuantile(freedom), variance = least / double(freedom);
  const auto inside = [&](double c) { return error(c) <= least + t * t * variance; };

  const LinearFit fit = fitExponent(lights, milliseconds, best);
  const double last = fit.a + fit.b * std::pow(lights.back(), best);
  const double rise = fit.b * (std::pow(lights.back(), best) - std::pow(lights.front(), best));
  // The difference of two measurements has twice the variance of one.
  if (inside(0) || rise < t * std::sqrt(2 * variance) * last) return {{}, "no growth beyond noise"};

  // The ends of the interval are searched from the best exponent outwards.
  double low = best, high = best;
  while (low > 0 && inside(low)) low -= kStep;
  while (high < kSteepest && inside(high)) high += kStep;
  const double c_low = findEdge(best, std::max(low, 0.0), inside);
  const bool is_bounded = high < kSteepest || !inside(kSteepest);
  const double c_high = is_bounded ? findEdge(best, std::min(high, kSteepest), inside) : kSteepest;
  if (!is_bounded || c_high - c_low > kWidestInterval)
    return {{},
            fmt::format("exponent anywhere from {:.2f} to {:.2f}{}", c_low, c_high,
                        is_bounded ? "" : " or more")};
  return {GrowthFit{fit.a, fit.b, best, c_low, c_high}, ""};
}

}  // namespace luciole
