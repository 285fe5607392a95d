#include "tools/figures/statistics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>

#include "base/random.hpp"

namespace luciole {
namespace {

/// The quantile of sorted values; share 0 is the first, 1 the last.
double quantile(const std::vector<double>& sorted, double share) {
  const double rank = share * double(sorted.size() - 1);
  const std::size_t below = std::size_t(rank), above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (sorted[above] - sorted[below]) * (rank - double(below));
}

bool beats(const SpeedAndError& a, const SpeedAndError& b) {
  const double noise = a.time.spread + b.time.spread;
  const double error_a = printedError(a.error), error_b = printedError(b.error);
  if (error_a < error_b) return a.time.median <= b.time.median + noise;
  return error_a == error_b && a.time.median < b.time.median - noise;
}

}  // namespace

Repeated summarize(std::vector<double> runs) {
  const auto [low, median, high] = quartiles(std::move(runs));
  return {median, (high - low) / 2};
}

Quartiles quartiles(std::vector<double> runs) {
  std::sort(runs.begin(), runs.end());
  return {quantile(runs, 0.25), quantile(runs, 0.5), quantile(runs, 0.75)};
}

std::optional<TimeRatio> timeRatio(const std::vector<double>& over, const std::vector<double>& under) {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < over.size(); ++i) {
    if (!(over[i] > 0 && under[i] > 0)) return std::nullopt;
    ratios.push_back(over[i] / under[i]);
  }
  if (ratios.size() < kFewestRatios) return std::nullopt;
  std::uint64_t random = 0;
  std::vector<double> drawn(ratios.size()), medians;
  for (int i = 0; i < kResamples; ++i) {
    for (double& ratio : drawn) ratio = ratios[std::size_t(nextUniform(random) * double(ratios.size()))];
    medians.push_back(quartiles(drawn).median);
  }
  std::sort(medians.begin(), medians.end());
  return TimeRatio{quartiles(ratios).median, quantile(medians, 0.025), quantile(medians, 0.975)};
}

double printedError(double error) { return std::stod(fmt::format("{:.1e}", error)); }

std::vector<bool> paretoFront(const std::vector<SpeedAndError>& rows) {
  std::vector<bool> front;
  for (const SpeedAndError& row : rows)
    front.push_back(std::none_of(rows.begin(), rows.end(),
                                 [&](const SpeedAndError& other) { return beats(other, row); }));
  return front;
}

}  // namespace luciole
