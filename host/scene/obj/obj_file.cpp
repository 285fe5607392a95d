#include "scene/obj/obj_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>

#include "base/error.hpp"
#include "base/text_file.hpp"

namespace luciole {
namespace {

constexpr int kMostCorners = 255;  // triangulating a polygon of n corners takes up to n³ steps

/// One of the three numbered lists of an OBJ file, and the largest index of it that a face uses.
struct List {
  const char* name;
  std::int64_t count = 0;
  std::int64_t furthest = 0;
  int furthest_line = 0;
};

struct Reader {
  const std::string& path;
  ObjFile file = {};
  int line = 1;
  List positions{"vertex"}, uvs{"texture coordinate"}, normals{"normal"};
  bool has_smoothing = false;
  unsigned smoothing = 0;

  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(fmt::format("{}: line {}: {}", path, line, what));
  }
};

bool isBlank(char c) { return c == ' ' || c == '\t'; }

std::string_view trimmed(std::string_view words) {
  while (!words.empty() && isBlank(words.front())) words.remove_prefix(1);
  while (!words.empty() && isBlank(words.back())) words.remove_suffix(1);
  return words;
}

/// Takes the next word off the front of `rest`; empty at the end.
std::string_view takeWord(std::string_view& rest) {
  const char* begin = std::find_if_not(rest.begin(), rest.end(), isBlank);
  const char* end = std::find_if(begin, rest.end(), isBlank);
  rest = {end, rest.end()};
  return {begin, end};
}

/// Takes the next line off the front of `rest`. Lines end with \n, \r or \r\n.
std::string_view takeLine(std::string_view& rest) {
  const char* end = std::find_if(rest.begin(), rest.end(), [](char c) { return c == '\n' || c == '\r'; });
  const std::string_view line{rest.begin(), end};
  const std::size_t taken = line.size() + (rest.substr(line.size(), 2) == "\r\n" ? 2 : 1);
  rest.remove_prefix(std::min(taken, rest.size()));
  return trimmed(line);
}

/// Takes the next line off the front of `rest`, with those that a backslash at its end continues. `joined`
/// keeps the characters of a statement of several lines.
std::string_view takeStatement(std::string_view& rest, std::string& joined, int& lines) {
  std::string_view statement = takeLine(rest);
  for (lines = 1; statement.ends_with('\\') && !statement.starts_with('#'); ++lines) {
    if (lines == 1) joined = statement;
    joined.back() = ' ';
    joined += takeLine(rest);
    statement = joined;
  }
  return statement;
}

std::optional<float> finiteNumber(std::string_view word) {
  if (word.starts_with('+') && !word.starts_with("+-")) word.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  const bool is_number = error == std::errc() && end == word.data() + word.size();
  if (!is_number || !(std::abs(value) <= std::numeric_limits<float>::max())) return std::nullopt;
  return static_cast<float>(value);
}

/// The numbers of a v, vt or vn: at least `required`, at most `most`; missing ones are 0.
glm::vec3 takeNumbers(Reader& reader, List& list, std::string_view& rest, int required, int most) {
  glm::vec3 numbers(0);
  for (int found = 0; found < most; ++found) {
    const std::string_view word = takeWord(rest);
    if (word.empty() && found >= required) break;
    if (word.empty()) reader.fail(fmt::format("a {} needs {} numbers, found {}", list.name, required, found));
    const std::optional<float> number = finiteNumber(word);
    if (!number) reader.fail(fmt::format("'{}' is not a finite number", forMessage(word)));
    numbers[found] = *number;
  }
  ++list.count;
  return numbers;
}

/// The three numbers after a position; empty where they are missing.
std::optional<glm::vec3> takeColor(std::string_view& rest) {
  glm::vec3 color;
  for (int i = 0; i < 3; ++i) {
    const std::optional<float> number = finiteNumber(takeWord(rest));
    if (!number) return std::nullopt;
    color[i] = *number;
  }
  return color;
}

/// Converts an index from 1, or a negative one from the end, to one from 0. It may refer to what comes later
/// in the file.
int readIndex(Reader& reader, std::string_view word, List& list) {
  std::int64_t index = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), index);
  if (error != std::errc() || end != word.data() + word.size()) {
    reader.fail(fmt::format("'{}' is not an index of a face", forMessage(word)));
  }
  if (index == 0) reader.fail("index 0 in a face, but indices start at 1");
  if (index < -list.count) {
    reader.fail(
        fmt::format("a face refers to {} {}, but only {} come before it", list.name, index, list.count));
  }
  if (index > list.furthest) {
    list.furthest = index;
    list.furthest_line = reader.line;
  }
  return static_cast<int>(index > 0 ? index - 1 : list.count + index);
}

/// A corner is v, v/vt, v//vn or v/vt/vn. Some programs write slashes at its end.
ObjCorner readCorner(Reader& reader, std::string_view rest) {
  while (rest.ends_with('/')) rest.remove_suffix(1);
  std::array<std::string_view, 3> words;
  for (std::size_t i = 0;; ++i) {
    if (i == words.size()) reader.fail("a corner of a face has more than 3 indices");
    const std::size_t slash = rest.find('/');
    words[i] = rest.substr(0, slash);
    if (slash == rest.npos) break;
    rest.remove_prefix(slash + 1);
  }
  ObjCorner corner;
  corner.position = readIndex(reader, words[0], reader.positions);
  if (!words[1].empty()) corner.uv = readIndex(reader, words[1], reader.uvs);
  if (!words[2].empty()) corner.normal = readIndex(reader, words[2], reader.normals);
  return corner;
}

void readFace(Reader& reader, std::string_view rest) {
  ObjFile& file = reader.file;
  ObjFace face{file.corners.size(), 0, static_cast<int>(file.material_names.size()) - 1, reader.smoothing};
  for (std::string_view word; !(word = takeWord(rest)).empty(); ++face.corner_count) {
    if (face.corner_count == kMostCorners)
      reader.fail(fmt::format("a face has more than {} corners", kMostCorners));
    file.corners.push_back(readCorner(reader, word));
  }
  file.faces.push_back(face);
}

/// "on" is group 1; "off" and other words are no group.
void readSmoothing(Reader& reader, std::string_view group) {
  reader.has_smoothing = true;
  if (group.empty()) return;
  reader.smoothing = group == "on";
  std::from_chars(group.data(), group.data() + group.size(), reader.smoothing);
}

void readStatement(Reader& reader, std::string_view rest) {
  const std::string_view keyword = takeWord(rest);
  ObjFile& file = reader.file;
  if (keyword == "usemtl") {
    file.material_names.emplace_back(trimmed(rest));
    return;
  }
  if (keyword == "mtllib") {
    file.material_files.emplace_back(trimmed(rest));
    return;
  }
  rest = rest.substr(0, rest.find('#'));
  if (keyword == "v") {
    file.positions.push_back(takeNumbers(reader, reader.positions, rest, 3, 3));
    if (const std::optional<glm::vec3> color = takeColor(rest)) file.colors.push_back(*color);
  } else if (keyword == "vt") {
    file.uvs.emplace_back(takeNumbers(reader, reader.uvs, rest, 1, 2));
  } else if (keyword == "vn") {
    file.normals.push_back(takeNumbers(reader, reader.normals, rest, 3, 3));
  } else if (keyword == "f") {
    readFace(reader, rest);
  } else if (keyword == "s") {
    readSmoothing(reader, takeWord(rest));
  }
}

}  // namespace

ObjFile readObjFile(const std::string& path) {
  const std::string text = readFile(path);
  if (text.find('\0') != std::string::npos) {
    throw InputError(path +
                     ": holds zero bytes, expected OBJ as ASCII or UTF-8 text (UTF-16 is not supported)");
  }
  std::string_view rest = text;
  if (rest.starts_with("\xef\xbb\xbf")) rest.remove_prefix(3);

  Reader reader{path};
  std::string joined;
  for (int lines = 1; !rest.empty(); reader.line += lines) {
    readStatement(reader, takeStatement(rest, joined, lines));
  }
  for (const List* list : {&reader.positions, &reader.uvs, &reader.normals}) {
    if (list->furthest <= list->count) continue;
    reader.line = list->furthest_line;
    reader.fail(fmt::format("a face refers to {} {}, but the file has only {}", list->name, list->furthest,
                            list->count));
  }
  ObjFile& file = reader.file;
  if (file.colors.size() < file.positions.size()) file.colors.clear();
  if (!reader.has_smoothing) {
    for (ObjFace& face : file.faces) face.smoothing = 1;
  }
  return std::move(reader.file);
}

}  // namespace luciole
