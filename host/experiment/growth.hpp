#pragma once

#include <optional>
#include <vector>

namespace luciole {

/// Fitted growth of a cost with the number of lights: milliseconds ≈ a + b·lights^c.
struct Growth {
  double a = 0;  ///< milliseconds that any number of lights costs, ≥ 0
  double b = 0;  ///< milliseconds, ≥ 0
  /// The exponent, and the ends of its 95 % confidence interval, which lie in [0, kSteepest]. None where the
  /// measurements don't tell: three points or fewer, or a cost that doesn't grow.
  std::optional<double> c, c_low, c_high;
};
inline constexpr double kSteepest = 3;

/// The weighted least-squares fit, each point's weight the reciprocal of its square: what counts is by which
/// share a point is missed, since costs span decades. The interval holds the exponents whose best fit is not
/// worse than the best of all by more than noise as large as the residuals explains (D. Bates and D. Watts,
/// "Nonlinear Regression Analysis and Its Applications", 1988, section 6.1). As many `milliseconds`, > 0, as
/// `lights`, ≥ 1, of which there is one at least.
Growth fitGrowth(const std::vector<double>& lights, const std::vector<double>& milliseconds);

}  // namespace luciole
