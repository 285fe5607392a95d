#include "base/csv.hpp"

namespace luciole {
namespace {

std::string csvCell(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted(1, '"');
  for (const char c : text) {
    if (c == '"') quoted += c;
    quoted += c;
  }
  quoted += '"';
  return quoted;
}

}  // namespace

std::string csvLine(const std::vector<std::string>& cells) {
  std::string line;
  const char* separator = "";
  for (const std::string& cell : cells) {
    line += separator;
    line += csvCell(cell);
    separator = ",";
  }
  return line + '\n';
}

}  // namespace luciole
