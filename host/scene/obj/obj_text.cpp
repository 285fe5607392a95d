#include "scene/obj/obj_text.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>

namespace luciole {
namespace {

bool isBlank(char c) { return static_cast<unsigned char>(c) <= ' '; }

/// Whether a decimal number that no double can hold is too near to 0, rather than too large: by the power of
/// ten of its first digit above 0.
bool isTooSmall(std::string_view word) {
  const std::size_t e = word.find_first_of("eE");
  int power = 0;
  if (e != word.npos) {
    std::string_view digits = word.substr(e + 1);
    if (digits.starts_with('+')) digits.remove_prefix(1);
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), power);
    if (error != std::errc()) return digits.starts_with('-');
  }
  const std::string_view mantissa = word.substr(0, e);
  const std::size_t first = mantissa.find_first_of("123456789");
  if (first == mantissa.npos) return true;
  const std::size_t point = std::min(mantissa.find('.'), mantissa.size());
  return power + std::int64_t(point) - std::int64_t(first) < 0;
}

}  // namespace

std::string_view withoutMark(std::string_view text) {
  return text.starts_with("\xef\xbb\xbf") ? text.substr(3) : text;
}

std::string_view trimmed(std::string_view words) {
  while (!words.empty() && isBlank(words.front())) words.remove_prefix(1);
  while (!words.empty() && isBlank(words.back())) words.remove_suffix(1);
  return words;
}

std::string_view takeWord(std::string_view& rest) {
  const char* begin = std::find_if_not(rest.begin(), rest.end(), isBlank);
  const char* end = std::find_if(begin, rest.end(), isBlank);
  rest = {end, rest.end()};
  return {begin, end};
}

std::string_view takeLine(std::string_view& rest) {
  const char* end = std::find_if(rest.begin(), rest.end(), [](char c) { return c == '\n' || c == '\r'; });
  const std::string_view line{rest.begin(), end};
  const std::size_t taken = line.size() + (rest.substr(line.size(), 2) == "\r\n" ? 2 : 1);
  rest.remove_prefix(std::min(taken, rest.size()));
  return trimmed(line);
}

std::string_view takeStatement(std::string_view& rest, std::string& joined, int& lines) {
  std::string_view line = takeLine(rest), statement = line;
  // A comment may end with the backslash of a path, which continues nothing.
  const auto goes_on = [&] {
    return line.ends_with('\\') && nameWithoutComment(line, true).size() == line.size();
  };
  for (lines = 1; goes_on(); ++lines) {
    if (lines == 1) joined = line;
    joined.back() = ' ';
    line = takeLine(rest);
    joined += line;
    statement = joined;
  }
  return statement;
}

std::string_view withoutComment(std::string_view words) {
  for (std::size_t at = words.find('#'); at != words.npos; at = words.find('#', at + 1))
    if (at == 0 || words[at - 1] != '.') return trimmed(words.substr(0, at));
  return words;
}

std::string_view nameWithoutComment(std::string_view name, bool any_word) {
  for (std::size_t at = name.find('#'); at != name.npos; at = name.find('#', at + 1)) {
    const bool begins = at == 0 || isBlank(name[at - 1]);
    const bool ends = any_word || at + 1 == name.size() || isBlank(name[at + 1]);
    if (begins && ends) return trimmed(name.substr(0, at));
  }
  return name;
}

std::string_view withoutQuotes(std::string_view name) {
  for (const char quote : {'"', '\''})
    if (name.size() >= 2 && name.front() == quote && name.back() == quote)
      return trimmed(name.substr(1, name.size() - 2));
  return name;
}

std::optional<double> finiteDouble(std::string_view word) {
  if (word.starts_with('+') && !word.starts_with("+-")) word.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (end != word.data() + word.size() || error == std::errc::invalid_argument) return std::nullopt;
  if (error == std::errc::result_out_of_range) return isTooSmall(word) ? std::optional(0.0) : std::nullopt;
  if (!(std::abs(value) <= std::numeric_limits<float>::max())) return std::nullopt;
  return value;
}

std::optional<float> finiteNumber(std::string_view word) {
  const std::optional<double> number = finiteDouble(word);
  return number ? std::optional(static_cast<float>(*number)) : std::nullopt;
}

bool isKeyword(std::string_view word, std::string_view lower) {
  return std::equal(word.begin(), word.end(), lower.begin(), lower.end(), [](char c, char l) {
    return (c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c) == l;
  });
}

}  // namespace luciole
