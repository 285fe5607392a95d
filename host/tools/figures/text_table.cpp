#include "tools/figures/text_table.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace luciole {

std::size_t shownWidth(const std::string& text) {
  return std::size_t(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

std::string textTable(const std::vector<std::vector<std::string>>& lines) {
  std::vector<std::size_t> widths(lines.front().size());
  for (const std::vector<std::string>& line : lines)
    for (std::size_t i = 0; i < line.size(); ++i) widths[i] = std::max(widths[i], shownWidth(line[i]));
  std::string text;
  for (std::size_t n = 0; n < lines.size(); ++n) {
    for (std::size_t i = 0; i < widths.size(); ++i) {
      const std::string blanks(widths[i] - shownWidth(lines[n][i]), ' ');
      text +=
          i == 0 ? fmt::format("| {}{} |", lines[n][i], blanks) : fmt::format(" {}{} |", blanks, lines[n][i]);
    }
    text += "\n";
    if (n > 0) continue;
    for (std::size_t i = 0; i < widths.size(); ++i)
      text +=
          i == 0 ? fmt::format("|{:-<{}}|", "", widths[i] + 2) : fmt::format("{:-<{}}:|", "", widths[i] + 1);
    text += "\n";
  }
  return text;
}

}  // namespace luciole
