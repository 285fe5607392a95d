#pragma once

#include <optional>
#include <string>
#include <vector>

namespace luciole {

/// A logarithmic axis. Zero, which has no place on it, is drawn at a floor of its own below all else.
struct LogAxis {
  double low = 0, high = 0;     ///< 0 < low < high
  std::optional<double> floor;  ///< where zero is drawn, where there is one

  /// Where a value lies between the ends, 0 to 1; what is beyond them, at the end.
  double place(double value) const;
};

/// An axis with some room around the values, ≥ 0: this share of their distance at each end, a little at
/// least.
LogAxis axisAround(const std::vector<double>& values, double room = 0.05);

/// Round numbers in [low, high], 0 < low < high, for a logarithmic axis: powers of ten where the range holds
/// three of them or more, every second or third of them where that would be more than `most`; else as many of
/// their multiples as it takes to have three.
std::vector<double> logTicks(double low, double high, int most = 9);

/// A tick's number for people to read: 10 µs, 3 ms, 1 s.
std::string timeTick(double milliseconds);
/// 1, 100, 10k, 1M
std::string countTick(double count);
/// 30, 0.1, 3·10⁻⁵
std::string errorTick(double error);

}  // namespace luciole
