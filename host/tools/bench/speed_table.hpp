#pragma once

#include <string>
#include <variant>
#include <vector>

#include "tools/figures/statistics.hpp"

namespace luciole {

/// A column of figures.
struct SpeedColumn {
  std::string key;   ///< in JSON
  std::string head;  ///< in the table, with the unit
  int decimals = 0;  ///< in the table
};

/// Stands for a figure that has no value.
struct NoValue {
  std::string why{};  ///< for people
};

/// A figure that would take too long to measure, extrapolated from others.
struct Estimate {
  double value = 0;
};

/// A cell: no value, a figure that is counted or computed, one from repeated runs, or one that is estimated.
using SpeedCell = std::variant<NoValue, double, Repeated, Estimate>;

/// over / under. If `under` is 0: no value, because of `why`.
SpeedCell quotient(double over, double under, const std::string& why);

/// Median and spread of one row's times over another's, round by round. No value if a round of `under` took
/// no measurable time.
SpeedCell ratio(const std::vector<double>& over, const std::vector<double>& under);

struct SpeedRow {
  std::string name;
  std::vector<SpeedCell> cells;  ///< one a column
};

/// A measurement's result: rows that compare with one another.
struct SpeedTable {
  std::string name;
  std::string measured;  ///< in a sentence, for people
  std::vector<SpeedColumn> columns;
  std::vector<SpeedRow> rows{};
  std::vector<std::string> failures{};  ///< violated guarantees of the program, a line each, for people
};

}  // namespace luciole
