#pragma once

#include <string>
#include <vector>

#include "luciole/warning.hpp"

namespace luciole::test {

inline std::vector<std::string> textsOf(const std::vector<Warning>& warnings) {
  std::vector<std::string> texts;
  for (const Warning& warning : warnings) texts.push_back(warning.text);
  return texts;
}

}  // namespace luciole::test
