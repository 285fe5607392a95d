#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "tools/cli/run_program.hpp"

namespace luciole::test {

using Row = std::map<std::string, std::string>;

/// A CSV file without quotes in it, a line a row.
inline std::vector<Row> readCsv(const std::string& path) {
  std::istringstream lines(readText(path));
  const auto cellsOf = [](const std::string& line) {
    std::vector<std::string> cells(1);
    for (const char c : line) {
      if (c == ',')
        cells.emplace_back();
      else
        cells.back() += c;
    }
    return cells;
  };
  std::string line;
  std::getline(lines, line);
  const std::vector<std::string> head = cellsOf(line);
  std::vector<Row> rows;
  while (std::getline(lines, line)) {
    const std::vector<std::string> cells = cellsOf(line);
    EXPECT_EQ(cells.size(), head.size());
    rows.emplace_back();
    for (std::size_t i = 0; i < cells.size() && i < head.size(); ++i) rows.back()[head[i]] = cells[i];
  }
  return rows;
}

/// Without what no two runs have in common: times, the front that they decide, and the process's memory.
inline std::vector<Row> withoutTimes(std::vector<Row> rows) {
  for (Row& row : rows)
    std::erase_if(row, [](const auto& cell) {
      const bool is_time = cell.first.find("ms") != std::string::npos && !cell.first.ends_with("mse");
      return is_time || cell.first.starts_with("times") || cell.first == "front" ||
             cell.first == "peak_bytes";
    });
  return rows;
}

inline std::vector<std::string> linesOf(const std::string& path) {
  std::istringstream file(readText(path));
  std::vector<std::string> lines;
  for (std::string line; std::getline(file, line);) lines.push_back(line);
  return lines;
}

class ScaleCommand : public testing::Test {
 protected:
  ScaleCommand() { writeText(folder / "scene.json", kSmallScene); }

  Outcome scale(const std::string& arguments) {
    return runLine(folder, "luciole scale scene.json --size " + size + " --check-pixels 40 " + arguments);
  }
  void succeed(const std::string& arguments) {
    const Outcome outcome = scale(arguments);
    ASSERT_EQ(outcome.status, 0) << arguments << "\n" << outcome.err;
  }
  /// What standard error says of wrong input.
  std::string refuse(const std::string& arguments) {
    const Outcome outcome = scale(arguments);
    EXPECT_EQ(outcome.status, 2) << arguments << "\n" << outcome.err;
    EXPECT_TRUE(isOneLine(outcome.err)) << outcome.err;
    return outcome.err;
  }

  const TemporaryFolder folder;
  std::string size = "48x27";
};

}  // namespace luciole::test
