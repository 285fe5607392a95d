#pragma once

#include <string>
#include <vector>

namespace luciole {

/// The parts of a text between separators; the whole text if there is no separator.
inline std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == separator)
      parts.emplace_back();
    else
      parts.back() += c;
  }
  return parts;
}

}  // namespace luciole
