#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "luciole/shader.hpp"

namespace luciole {

using Text = std::string_view;

/// A word, a number or a sign of a shader's text, which must outlive it.
struct Token {
  Text text;
  int line = 0, column = 0;   ///< from 1
  bool of_directive = false;  ///< of a line that begins with #
};

/// Throws InputError, "FILE:LINE:COLUMN: what".
[[noreturn]] void failAt(const Shader& shader, int line, int column, const std::string& what);

/// Whether a token is a name, and whether it is a number.
bool isName(Text text);
bool isNumber(Text text);

/// The tokens of a text, without blanks and comments. Throws InputError for what compilers read in several
/// ways: lines that \ joins, trigraphs, control characters.
std::vector<Token> tokensOf(const Shader& shader);

}  // namespace luciole
