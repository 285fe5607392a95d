#pragma once

#include <string>
#include <vector>

namespace luciole {

/// Lines of cells, the first one the head, as a Markdown table that reads well as plain text: the first
/// column left, the others right. All lines have as many cells.
std::string textTable(const std::vector<std::vector<std::string>>& lines);

}  // namespace luciole
