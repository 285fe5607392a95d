#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "figures/statistics.hpp"

namespace luciole {

/// Called now and then, if set.
using OnProgress = std::function<void(const std::string& what, std::size_t done, std::size_t total)>;

/// What a row of an experiment gave: figures[i] holds figure i of every round, in order.
struct RoundFigures {
  std::vector<std::vector<double>> figures;

  Repeated summary(std::size_t figure) const { return summarize(figures[figure]); }
};

/// Runs every row once a round, each round beginning with another one, so that what else the machine does
/// falls on all alike. `run(row)` gives the row's figures, as many each time. `what` is for on_progress.
std::vector<RoundFigures> runInRounds(std::size_t rows, int rounds, const std::string& what,
                                      const OnProgress& on_progress,
                                      const std::function<std::vector<double>(std::size_t row)>& run);

}  // namespace luciole
