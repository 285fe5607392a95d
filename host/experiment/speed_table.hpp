#pragma once

#include <string>
#include <variant>
#include <vector>

#include "experiment/statistics.hpp"

namespace luciole {

/// A column of figures.
struct SpeedColumn {
  std::string key;   ///< in JSON
  std::string head;  ///< in the table, with the unit
  int decimals = 0;  ///< in the table
};

/// A figure that is counted or computed, one that repeated runs gave, or none.
using SpeedCell = std::variant<std::monostate, double, Repeated>;

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
