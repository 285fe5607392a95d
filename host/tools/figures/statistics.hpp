#pragma once

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
