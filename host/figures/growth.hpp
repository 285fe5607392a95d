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

/// A fit, or why there is none.
struct Growth {
  std::optional<GrowthFit> fit;
  std::string reason;
};

/// Exponents are looked for up to here.
inline constexpr double kSteepest = 3;
/// An exponent whose interval is wider than this isn't told: it can hold both of a constant and a linear
/// cost, or both of a linear and a quadratic one.
inline constexpr double kWidestInterval = 1;
/// Three numbers are fitted. With a single measurement more the noise is known from one residual, and
/// Student's quantile is 12.7; with two more it is 4.3.
inline constexpr int kFewestCounts = 5;

/// The weighted least-squares fit, each point's weight the reciprocal of its square: what counts is by which
/// share a point is missed, since costs span decades. The interval holds the exponents whose best fit is not
/// worse than the best of all by more than noise as large as the residuals explains (D. Bates and D. Watts,
/// "Nonlinear Regression Analysis and Its Applications", 1988, section 6.1). There is a fit where
///   - there are kFewestCounts points;
///   - a constant fits worse by more than that noise;
///   - the cost rises, from the fewest lights to the most, by more than two measurements of one cost differ
///   in
///     19 of 20 pairs;
///   - the interval has both its ends in (0, kSteepest), and is no wider than kWidestInterval.
/// As many `milliseconds`, > 0, as `lights`, ≥ 1 and rising, of which there is one at least.
Growth fitGrowth(const std::vector<double>& lights, const std::vector<double>& milliseconds);

}  // namespace luciole
