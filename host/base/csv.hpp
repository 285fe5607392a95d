#pragma once

#include <string>
#include <vector>

namespace luciole {

/// A line of a CSV file, its cells quoted where RFC 4180 asks for it.
std::string csvLine(const std::vector<std::string>& cells);

}  // namespace luciole
