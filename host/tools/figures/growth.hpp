#pragma once

#include <optional>
#include <string>
#include <vector>

namespace luciole {

/// Fitted growth of a cost with the number of lights: milliseconds ≈ a + b·lights^c.
struct GrowthFit {
  double a = 0;                         ///< milliseconds that any number of lights costs, ≥ 0
  double b = 0;                         ///< milliseconds, > 0
  double c = 0, c_low = 0, c_high = 0;  ///< the exponent, and the ends of its 95 % confidence interval
};

/// A fit, or the reason why there is none, for people.
struct Growth {
  std::optional<GrowthFit> fit;
  std::string reason;
};

/// The largest exponent that is tried.
inline constexpr double kSteepest = 3;
/// The widest confidence interval of a fit. A wider one says too little: it may hold both a constant and a
/// linear cost, or both a linear and a quadratic one.
inline constexpr double kWidestInterval = 1;
/// The fewest points of a fit, two more than the three numbers that are fitted. With only one more the noise
/// would be estimated with a single degree of freedom, where Student's quantile is 12.7; with two it is 4.3.
inline constexpr int kFewestCounts = 5;

/// Fits a, b ≥ 0 and c in [0, kSteepest] by least squares of relative residuals, because costs span decades.
/// The interval holds the exponents whose best fit isn't worse than the best of all by more than noise as
/// large as the residuals explains (D. Bates and D. Watts, "Nonlinear Regression Analysis and Its
/// Applications", 1988, section 6.1). There is a fit if
///   - there are at least kFewestCounts points;
///   - a constant fits worse by more than that noise;
///   - from the fewest lights to the most the cost rises by more than what two measurements of the same cost
///     differ by in 19 of 20 pairs;
///   - both ends of the interval lie in (0, kSteepest), and it is no wider than kWidestInterval.
/// milliseconds: > 0, one for each of `lights`. lights: ≥ 1, rising, at least one.
Growth fitGrowth(const std::vector<double>& lights, const std::vector<double>& milliseconds);

}  // namespace luciole
