#pragma once

#include <optional>
#include <string>
#include <vector>

namespace luciole {

/// A logarithmic axis. Zero, which has no place on it, is drawn at a floor of its own below all else.
struct LogAxis {
  double low = 0, high = 0;     ///< 0 < low < high
  std::optional<double> floor;  ///< where zero is drawn, where there is one

  /// Where a value lies between the ends, in [0, 1]; a value beyond an end lies at the end.
  double place(double value) const;
};

/// An axis around values ≥ 0, with free room at each end: `room` is its share of the distance between the
/// least and the largest value on the axis, and there is always a little.
LogAxis axisAround(const std::vector<double>& values, double room = 0.05);

/// Round numbers in [low, high], 0 < low < high, for a logarithmic axis: powers of ten if the range holds
/// three of them, otherwise as many of their multiples as it takes to have three. If there are more than
/// `most`, only every second, third … of them.
std::vector<double> logTicks(double low, double high, int most = 9);

/// A tick's text for a time: 10 µs, 3 ms, 1 s.
std::string timeTick(double milliseconds);
/// A tick's text for a count: 1, 100, 10k, 1M.
std::string countTick(double count);
/// A tick's text for an error: 30, 0.1, 3·10⁻⁵.
std::string errorTick(double error);

}  // namespace luciole
