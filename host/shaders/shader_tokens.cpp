#include "shaders/shader_tokens.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "luciole/error.hpp"

namespace luciole {
namespace {

bool isNameStart(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool isDigit(char c) { return c >= '0' && c <= '9'; }

/// Operators of several characters. The last five are other spellings of brackets and #.
constexpr Text kOperators[] = {
    "<<=", ">>=", "->", "++", "--", "<<", ">>", "<=", ">=", "==", "!=", "&&", "||", "+=",
    "-=",  "*=",  "/=", "%=", "&=", "|=", "^=", "##", "<:", ":>", "<%", "%>", "%:"};

/// Reads a text's tokens.
class Lexer {
 public:
  explicit Lexer(const Shader& shader) : shader_(shader), rest_(shader.text) {}

  std::vector<Token> tokens() {
    std::vector<Token> all;
    while (skipBlanks(), !rest_.empty()) {
      if (at_line_start_ && rest_[0] == '#') in_directive_ = true;
      at_line_start_ = false;
      const std::size_t length = tokenLength();
      all.push_back({rest_.substr(0, length), line_, column_, in_directive_});
      take(length);
    }
    return all;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { failAt(shader_, line_, column_, what); }

  /// Goes on. What would end or join lines for a compiler, but not here, is refused also in comments.
  void take(std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
      const char c = rest_[i];
      if (c == '\n') {
        column_ = 1;
        ++line_;
        continue;
      }
      const std::size_t next = rest_.find_first_not_of(" \t\r", i + 1);
      if (c == '\\' && (next == rest_.npos || rest_[next] == '\n')) fail("a \\ at a line's end");
      const bool ends_line = c == '\r' && (i + 1 == rest_.size() || rest_[i + 1] == '\n');
      if (c != '\t' && !ends_line && static_cast<unsigned char>(c) < 0x20)
        fail(fmt::format("the control character {}", int(c)));
      if (rest_.substr(i).starts_with("?"
                                      "?"))
        fail("two question marks: C reads them as another character");
      ++column_;
    }
    rest_.remove_prefix(count);
  }

  /// Skips blanks, comments, and the ends of lines, which end directives.
  void skipBlanks() {
    while (!rest_.empty()) {
      if (rest_[0] == '\n') {
        in_directive_ = false;
        at_line_start_ = true;
        take(1);
      } else if (rest_[0] == ' ' || rest_[0] == '\t' || rest_[0] == '\r') {
        take(1);
      } else if (rest_.starts_with("//")) {
        take(std::min(rest_.find('\n'), rest_.size()));
      } else if (rest_.starts_with("/*")) {
        const std::size_t end = rest_.find("*/", 2);
        if (end == rest_.npos) fail("this comment has no end");
        if (in_directive_ && rest_.substr(0, end).find('\n') != rest_.npos)
          fail("this comment goes on in the next line, and the directive with it");
        take(end + 2);
      } else {
        return;
      }
    }
  }

  std::size_t tokenLength() const {
    const char c = rest_[0];
    std::size_t length = 1;
    const auto next = [&] { return length < rest_.size() ? rest_[length] : '\0'; };
    if (isNameStart(c)) {
      while (isNameStart(next()) || isDigit(next())) ++length;
    } else if (isNumber(rest_)) {
      const auto is_sign = [&] {
        return (next() == '+' || next() == '-') && Text("eEpP").find(rest_[length - 1]) != Text::npos;
      };
      while (isNameStart(next()) || isDigit(next()) || next() == '.' || is_sign()) ++length;
    } else if (c == '"') {
      while (next() != '"' && next() != '\n' && next() != '\0') ++length;
      if (next() != '"') fail("this text has no closing \"");
      ++length;
    } else if (const auto* const found = std::find_if(std::begin(kOperators), std::end(kOperators),
                                                      [&](Text sign) { return rest_.starts_with(sign); });
               found != std::end(kOperators)) {
      length = found->size();
    } else if (Text("(){};,.+-*/<>=!&|^~?:#[]%").find(c) == Text::npos) {
      fail("this character has no meaning here");
    }
    return length;
  }

  const Shader& shader_;
  Text rest_;
  int line_ = 1, column_ = 1;
  bool at_line_start_ = true, in_directive_ = false;
};

}  // namespace

void failAt(const Shader& shader, int line, int column, const std::string& what) {
  throw InputError(fmt::format("{}:{}:{}: {}", shader.path, line, column, what));
}

bool isName(Text text) { return !text.empty() && isNameStart(text[0]); }
bool isNumber(Text text) {
  return !text.empty() && (isDigit(text[0]) || (text[0] == '.' && text.size() > 1 && isDigit(text[1])));
}

std::vector<Token> tokensOf(const Shader& shader) { return Lexer(shader).tokens(); }

}  // namespace luciole
