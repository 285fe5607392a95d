#pragma once

#include <string>

#include "tools/bench/bench.hpp"

namespace luciole {

/// The result as Markdown that reads well as plain text: for each group a table, and what its figures mean.
std::string benchTable(const BenchResult& result);

/// The result with all settings, as JSON.
std::string benchJson(const BenchResult& result);

}  // namespace luciole
