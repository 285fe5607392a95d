#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "tools/figures/statistics.hpp"

namespace luciole {

/// A progress report, if set: `done` of `total` steps of `what`.
using OnProgress = std::function<void(const std::string& what, std::size_t done, std::size_t total)>;

/// The figures of a row of an experiment: figures[i] holds figure i of every round, in order.
struct RoundFigures {
  std::vector<std::vector<double>> figures;

  Repeated summary(std::size_t figure) const { return summarize(figures[figure]); }
};

/// Runs every row once in each round. Each round begins with another row, so that other work on the machine
/// affects all rows alike. run(row): returns the row's figures, always the same number. what: for
/// on_progress.
std::vector<RoundFigures> runInRounds(std::size_t rows, int rounds, const std::string& what,
                                      const OnProgress& on_progress,
                                      const std::function<std::vector<double>(std::size_t row)>& run);

}  // namespace luciole
