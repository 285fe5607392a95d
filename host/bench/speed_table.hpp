#pragma once

#include <string>
#include <variant>
#include <vector>

#include "figures/statistics.hpp"

namespace luciole {

/// A column of figures.
struct SpeedColumn {
  std::string key;   ///< in JSON
  std::string head;  ///< in the table, with the unit
  int decimals = 0;  ///< in the table
};

/// In the place of a figure that there isn't.
struct NoValue {
  std::string why{};  ///< for people
};

/// A figure that is counted or computed, one that repeated runs gave, or none.
using SpeedCell = std::variant<NoValue, double, Repeated>;

/// How many times `under` goes into `over`, or `why` that has no value where it is 0.
SpeedCell quotient(double over, double under, const std::string& why);

/// One row's figures over another's, round by round; no value where a round of `under` took no time that
/// could be measured.
SpeedCell ratio(const std::vector<double>& over, const std::vector<double>& under);

struct SpeedRow {
  std::string name;
  std::vector<SpeedCell> cells;  ///< one a column
};

/// What a stage costs, in rows that compare with one another.
struct SpeedTable {
  std::string name;
  std::string measured;  ///< in a sentence, for people
  std::vector<SpeedColumn> columns;
  std::vector<SpeedRow> rows{};
};

}  // namespace luciole
