#include "scene/obj/obj_file.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "base/text_file.hpp"

namespace luciole {
namespace {

constexpr int kMostCorners = 255;  // triangulating a polygon of n corners takes up to n³ steps

/// One of the three numbered lists of an OBJ file, and the largest index of it that a face uses.
struct List {
  const char* name;
  std::int64_t before = 0;  ///< how many come before the part
  std::int64_t count = 0;   ///< how many the part has so far
  std::int64_t furthest = 0;
  int furthest_line = 0;
};

/// What is wrong with a part, which isn't read any further.
struct Fault {
  int line;
  std::string what;
};

/// Reads a part of the file, of whole statements. Lines, corners and materials are counted from its start.
struct Reader {
  std::string_view text;
  ObjFile file = {};
  int line = 1;
  List positions{"vertex"}, uvs{"texture coordinate"}, normals{"normal"};
  bool knows_before = false;  ///< how many of each list come before the part
  bool counts_back = false;   ///< it has negative indices: it must be read again when that is known
  bool has_smoothing = false;
  std::optional<unsigned> smoothing = {};  ///< of the statements so far
  std::size_t faces_before_smoothing = 0;  ///< they are of the group that the part before ends with
  std::optional<Fault> fault = {};

  [[noreturn]] void fail(const std::string& what) const { throw Fault{line, what}; }
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
  const std::int64_t count = list.before + list.count;
  if (index < 0 && !reader.knows_before) {
    reader.counts_back = true;
  } else if (index < -count) {
    reader.fail(fmt::format("a face refers to {} {}, but only {} come before it", list.name, index, count));
  }
  if (index > list.furthest) {
    list.furthest = index;
    list.furthest_line = reader.line;
  }
  return static_cast<int>(index > 0 ? index - 1 : count + index);
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
  ObjFace face{file.corners.size(), 0, static_cast<int>(file.material_names.size()) - 1,
               reader.smoothing.value_or(0)};
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
  if (!reader.smoothing) reader.faces_before_smoothing = reader.file.faces.size();
  unsigned number = group == "on";
  std::from_chars(group.data(), group.data() + group.size(), number);
  reader.smoothing = number;
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

void readPart(Reader& reader) {
  std::string_view rest = reader.text;
  std::string joined;
  try {
    for (int lines = 1; !rest.empty(); reader.line += lines)
      readStatement(reader, takeStatement(rest, joined, lines));
  } catch (Fault& fault) {
    reader.fault = std::move(fault);
  }
  if (!reader.smoothing) reader.faces_before_smoothing = reader.file.faces.size();
}

/// Cuts the text into parts of `part_bytes` bytes and some more, so that no statement is cut.
std::vector<Reader> cutIntoParts(std::string_view text, std::size_t part_bytes) {
  std::vector<Reader> parts;
  while (!text.empty()) {
    std::string_view rest = text.substr(std::min(part_bytes, text.size()));
    takeLine(rest);
    // A whole line without a backslash at its end is the last one of its statement.
    while (takeLine(rest).ends_with('\\')) {
    }
    parts.push_back({text.substr(0, text.size() - rest.size())});
    text = rest;
  }
  return parts;
}

constexpr List Reader::*kLists[] = {&Reader::positions, &Reader::uvs, &Reader::normals};

/// Reads those parts again that have negative indices.
void readCountingBack(std::vector<Reader>& parts) {
  for (std::size_t i = 1; i < parts.size(); ++i) {
    for (List Reader::*const list : kLists)
      (parts[i].*list).before = (parts[i - 1].*list).before + (parts[i - 1].*list).count;
  }
  tbb::parallel_for(std::size_t(0), parts.size(), [&](std::size_t i) {
    if (!parts[i].counts_back) return;
    Reader again{parts[i].text};
    for (List Reader::*const list : kLists) (again.*list).before = (parts[i].*list).before;
    again.knows_before = true;
    readPart(again);
    parts[i] = std::move(again);
  });
}

/// Throws InputError for the first thing that is wrong.
void checkParts(const std::string& path, const std::vector<Reader>& parts) {
  const auto fail = [&](int line, const std::string& what) {
    throw InputError(fmt::format("{}: line {}: {}", path, line, what));
  };
  int lines = 0;
  for (const Reader& part : parts) {
    if (part.fault) fail(lines + part.fault->line, part.fault->what);
    lines += part.line - 1;
  }
  for (List Reader::*const which : kLists) {
    std::int64_t furthest = 0, count = 0;
    int line = 0;
    lines = 0;
    for (const Reader& part : parts) {
      const List& list = part.*which;
      count += list.count;
      if (list.furthest > furthest) line = lines + list.furthest_line;
      furthest = std::max(furthest, list.furthest);
      lines += part.line - 1;
    }
    if (furthest > count)
      fail(line, fmt::format("a face refers to {} {}, but the file has only {}", (parts.front().*which).name,
                             furthest, count));
  }
}

template <class T>
void append(std::vector<T>& list, std::vector<T>& whole) {
  whole.insert(whole.end(), std::make_move_iterator(list.begin()), std::make_move_iterator(list.end()));
  list = {};
}

/// Puts the parts one after the other.
ObjFile joinParts(std::vector<Reader>& parts) {
  ObjFile whole;
  std::size_t positions = 0, uvs = 0, normals = 0, corners = 0, faces = 0;
  bool has_smoothing = false;
  for (const Reader& part : parts) {
    positions += part.file.positions.size();
    uvs += part.file.uvs.size();
    normals += part.file.normals.size();
    corners += part.file.corners.size();
    faces += part.file.faces.size();
    has_smoothing |= part.has_smoothing;
  }
  whole.positions.reserve(positions);
  whole.uvs.reserve(uvs);
  whole.normals.reserve(normals);
  whole.corners.reserve(corners);
  whole.faces.reserve(faces);
  unsigned smoothing = 0;  // that the part before ends with
  for (Reader& part : parts) {
    ObjFile& file = part.file;
    for (std::size_t i = 0; i < file.faces.size(); ++i) {
      ObjFace& face = file.faces[i];
      face.first_corner += whole.corners.size();
      face.material += static_cast<int>(whole.material_names.size());
      if (i < part.faces_before_smoothing) face.smoothing = smoothing;
      if (!has_smoothing) face.smoothing = 1;
    }
    smoothing = part.smoothing.value_or(smoothing);
    append(file.positions, whole.positions);
    append(file.colors, whole.colors);
    append(file.uvs, whole.uvs);
    append(file.normals, whole.normals);
    append(file.corners, whole.corners);
    append(file.faces, whole.faces);
    append(file.material_names, whole.material_names);
    append(file.material_files, whole.material_files);
  }
  if (whole.colors.size() < whole.positions.size()) whole.colors.clear();
  return whole;
}

}  // namespace

ObjFile readObjFile(const std::string& path, std::size_t part_bytes) {
  const std::string bytes = readFile(path);
  if (bytes.find('\0') != std::string::npos) {
    throw InputError(path +
                     ": holds zero bytes, expected OBJ as ASCII or UTF-8 text (UTF-16 is not supported)");
  }
  std::string_view text = bytes;
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);

  std::vector<Reader> parts = cutIntoParts(text, part_bytes);
  if (!parts.empty()) parts.front().knows_before = true;
  tbb::parallel_for(std::size_t(0), parts.size(), [&](std::size_t i) { readPart(parts[i]); });
  readCountingBack(parts);
  checkParts(path, parts);
  return joinParts(parts);
}

}  // namespace luciole
