#include <fmt/format.h>

#include <algorithm>
#include <regex>
#include <sstream>

#include "shaders/shader_text.hpp"
#include "shaders/shader_tokens.hpp"

namespace luciole {
namespace {

/// Takes the place of / in a program. So a quotient is one of floats also between integers, which would end
/// the program where the divisor is 0. A product with 1 changes no bit.
constexpr Text kQuotient = "*1.0F/";

/// A shader's text as it is compiled: without its includes, with safe quotients.
std::string compiledText(const Shader& shader, const std::vector<Token>& tokens) {
  std::string text;
  const char* done = shader.text.data();
  for (std::size_t i = 0; i < tokens.size(); ++i) {
    const Text token = tokens[i].text;
    if (token != "/" && !(token == "#" && i + 1 < tokens.size() && tokens[i + 1].text == "include")) continue;
    text.append(done, token.data());
    if (token == "/") {
      text += kQuotient;
      done = token.data() + 1;
    } else {
      const Text header = tokens[i + 2].text;
      done = header.data() + header.size();
    }
  }
  return text.append(done, shader.text.data() + shader.text.size()) + "\n";
}

/// What #line calls lines that are no user's.
constexpr Text kOwnLines = "shaders";

/// A path as it stands in #line, where " and \ end or change it.
std::string linePath(const std::string& path) {
  std::string quoted;
  for (const char c : path) quoted += c == '"' || c == '\\' || c == '\n' ? '_' : c;
  return quoted;
}

/// A compiler's words with the names that functions have in the file.
std::string asTheUserWrote(const std::string& words) {
  return std::regex_replace(words, std::regex("\\b__(\\w+)_\\d+\\b"), "$1");
}

}  // namespace

std::string shaderProgram(std::span<const Shader> shaders, ShaderKind kind) {
  if (shaders.empty()) return {};
  std::string program;
  bool grazing = false, colors = false;
  for (std::size_t i = 0; i < shaders.size(); ++i) {
    const Shader& shader = shaders[i];
    const std::vector<Token> tokens = tokensOf(shader);
    std::vector<Text> names, macros;
    for (std::size_t at = 0; at + 2 < tokens.size(); ++at) {
      if (tokens[at].text == "INLINE") names.push_back(tokens[at + 2].text);
      if (tokens[at].of_directive && tokens[at].text == "define") macros.push_back(tokens[at + 1].text);
    }
    const ShaderFacts facts = shaderFacts(shader, kind);
    grazing |= facts.uses_grazing;
    colors |= facts.uses_colors;
    // Names of one file are those of others, and of the kernels', without harm. No user can write the names
    // that functions get, by which they could call themselves.
    for (const Text name : macros) program += fmt::format("#pragma push_macro(\"{0}\")\n#undef {0}\n", name);
    for (const Text name : names) program += fmt::format("#define {0} __{0}_{1}\n", name, i);
    program += fmt::format("#line 1 \"{}\"\n{}#line 1 \"{}\"\n", linePath(shader.path),
                           compiledText(shader, tokens), kOwnLines);
    for (const Text name : names) program += fmt::format("#undef {}\n", name);
    for (const Text name : macros) program += fmt::format("#pragma pop_macro(\"{}\")\n", name);
  }
  switch (kind) {
    case ShaderKind::kModel:
      program += fmt::format("#define USER_MODEL_COUNT {}\n#define USER_GRAZING {}\n#define USER_COLORS {}\n",
                             shaders.size(), int(grazing), int(colors)) +
                 "INLINE Reflection user_reflection(uint number, const Surface *s, vec3L to_light, floatL "
                 "n_dot_l) {\n";
      for (std::size_t i = 1; i < shaders.size(); ++i)
        program += fmt::format("if (number == {0}) return __reflect_light_{0}(s, to_light, n_dot_l);\n", i);
      return program + "return __reflect_light_0(s, to_light, n_dot_l);\n}\n";
    case ShaderKind::kSurface:
      program += "#define USER_SURFACES\nINLINE void user_surface(Surface *s) {\n";
      for (std::size_t i = 0; i < shaders.size(); ++i) program += fmt::format("__surface_{}(s);\n", i);
      return program + "}\n";
    case ShaderKind::kScreen:
      break;
  }
  return program;
}

std::string shaderError(const std::string& log, const std::string& user_text) {
  std::istringstream lines(log);
  std::string first;
  // clang writes "FILE:LINE:COLUMN: error: what", and PoCL "error: FILE:LINE:COLUMN: what", with the place of
  // the kernels' own macros behind the user's.
  const std::regex place("(?:error: )?(.+):(\\d+):(\\d+)(?: <Spelling=[^>]*>)?: (?:fatal )?(?:error: )?(.*)");
  for (std::string line; std::getline(lines, line);) {
    std::smatch parts;
    if (line.find("error: ") == line.npos || !std::regex_match(line, parts, place)) continue;
    if (first.empty()) first = parts[4];
    const std::string path = parts[1];
    const std::size_t begin = user_text.find(fmt::format("#line 1 \"{}\"\n", path));
    if (begin == user_text.npos || path == kOwnLines) continue;
    const int number = std::stoi(parts[2]);
    std::istringstream of_user(user_text.substr(begin));
    std::string told;
    for (int i = 0; i <= number; ++i) std::getline(of_user, told);
    // Each quotient before the place has moved it.
    std::size_t column = std::size_t(std::stoi(parts[3])) - 1, moved = 0;
    for (std::size_t at = 0; (at = told.find(kQuotient, at)) < column; at += kQuotient.size())
      moved += std::min(column - at, kQuotient.size() - 1);
    return fmt::format("{}:{}:{}: {}", path, number, column - moved + 1, asTheUserWrote(parts[4]));
  }
  const std::size_t path = user_text.find("#line 1 \"") + 9;
  return fmt::format("{}: does not compile: {}", user_text.substr(path, user_text.find('"', path) - path),
                     first);
}

}  // namespace luciole
