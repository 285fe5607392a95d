#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace luciole {

/// The number of characters in UTF-8 text: of all bytes but those that continue a character.
std::size_t shownWidth(const std::string& text);

/// Lines of cells as a Markdown table that reads well as plain text. The first line is the head, the first
/// column is left-aligned, the others right. All lines must have the same number of cells.
std::string textTable(const std::vector<std::vector<std::string>>& lines);

}  // namespace luciole
