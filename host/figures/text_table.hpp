#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace luciole {

/// Characters that UTF-8 text shows as: all bytes but those that continue one.
std::size_t shownWidth(const std::string& text);

/// Lines of cells, the first one the head, as a Markdown table that reads well as plain text: the first
/// column left, the others right. All lines have as many cells.
std::string textTable(const std::vector<std::vector<std::string>>& lines);

}  // namespace luciole
