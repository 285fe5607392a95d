#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace luciole {

/// A figure from repeated runs, mostly milliseconds.
struct Repeated {
  double median = 0;
  double spread = 0;  ///< half the distance between the quartiles: about half of the runs lie this near
};

/// Median and spread of the runs, of which there must be one. O(n log n).
Repeated summarize(std::vector<double> runs);

/// The quartiles of repeated runs, interpolated linearly between ranks.
struct Quartiles {
  double low = 0, median = 0, high = 0;
};
Quartiles quartiles(std::vector<double> runs);

/// How many times as long one thing takes as another.
struct TimeRatio {
  double median = 0;         ///< of the rounds' ratios
  double low = 0, high = 0;  ///< the ends of its 95 % confidence interval
};
/// The fewest rounds that tell an interval. Those of fewer than ten or so are rough, and rather too narrow.
inline constexpr std::size_t kFewestRatios = 3;

/// The ratio over[i] / under[i] of round i, of which both times suffered from the same other work on the
/// machine. The interval is the bootstrap's (B. Efron and R. Tibshirani, "An Introduction to the Bootstrap",
/// 1993, chapter 13): between the percentiles 2.5 and 97.5 of the medians of kResamples draws of as many
/// rounds, with replacement. Draws are the same on every machine. Nothing if there are fewer than
/// kFewestRatios rounds or a time isn't above 0. The lengths must be equal. O(n log n · kResamples).
std::optional<TimeRatio> timeRatio(const std::vector<double>& over, const std::vector<double>& under);
inline constexpr int kResamples = 2000;

/// What a row of the experiment cost and how wrong it was.
struct SpeedAndError {
  Repeated time;
  double error = 0;  ///< mean absolute
};

/// An error rounded to two digits, as tables print it: errors that print alike count as equal.
double printedError(double error);

/// Which rows are on the Pareto front: those that no other row beats. A row beats another if its error is
/// smaller and it isn't slower by more than the sum of both spreads, or if its error is equal and it is
/// faster by more than that. The relation has no cycles, so the front of one row or more is never empty.
/// O(n²).
std::vector<bool> paretoFront(const std::vector<SpeedAndError>& rows);

}  // namespace luciole
