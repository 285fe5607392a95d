#pragma once

#include <string>

#include "bench/bench.hpp"

namespace luciole {

/// The result as Markdown that reads well as plain text: a table a group, and what its figures mean.
std::string benchTable(const BenchResult& result);

/// The same and every setting, as JSON.
std::string benchJson(const BenchResult& result);

}  // namespace luciole
