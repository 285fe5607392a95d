#pragma once

#include <vector>

namespace luciole {

/// A figure that repeated runs gave, mostly milliseconds.
struct Repeated {
  double median = 0;
  double spread = 0;  ///< half the distance between the quartiles: half of the runs lie about this near
};

/// Quartiles lie between the runs next to them, by linear interpolation of ranks. There is one run at least.
Repeated summarize(std::vector<double> runs);

/// The quartiles themselves.
struct Quartiles {
  double low = 0, median = 0, high = 0;
};
Quartiles quartiles(std::vector<double> runs);

/// What a row of the experiment cost and how wrong it was.
struct SpeedAndError {
  Repeated time;
  double error = 0;  ///< mean absolute
};

/// An error as tables print it, two digits: errors that print alike count as equal.
double printedError(double error);

/// Which rows are on the Pareto front: those that no other row beats. One row beats another where it is
/// nearer to the truth and not slower by more than both their spreads, or as near and faster by more than
/// both. Nobody beats a row in a circle, so the front is never empty.
std::vector<bool> paretoFront(const std::vector<SpeedAndError>& rows);

}  // namespace luciole
