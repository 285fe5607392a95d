#include "scene/obj/obj_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string_view>

#include "base/error.hpp"
#include "base/text_file.hpp"

namespace luciole {
namespace {

constexpr std::string_view kBlanks = " \t";
constexpr int kMostCorners = 255;  // tinyobjloader counts a face's corners in a byte

/// The characters from `begin` to `end` of the text.
struct Range {
  std::size_t begin;
  std::size_t end;
};

/// One of the three numbered lists of an OBJ file, and the furthest that a face reaches into it.
struct List {
  const char* name;
  std::int64_t count = 0;
  std::int64_t furthest = 0;
  int furthest_line = 0;
};

struct Scan {
  const std::string& path;
  ObjText& obj;
  int line = 1;
  List lists[3] = {{"vertex"}, {"texture coordinate"}, {"normal"}};

  std::string_view view(Range range) const {
    return std::string_view(obj.text).substr(range.begin, range.end - range.begin);
  }
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(fmt::format("{}: line {}: {}", path, line, what));
  }
};

void blankOut(std::string& text, Range range) {
  std::fill(text.begin() + range.begin, text.begin() + range.end, ' ');
}

Range trimmed(const std::string& text, Range range) {
  while (range.begin < range.end && kBlanks.find(text[range.begin]) != kBlanks.npos) ++range.begin;
  while (range.begin < range.end && kBlanks.find(text[range.end - 1]) != kBlanks.npos) --range.end;
  return range;
}

/// Takes the next word off the front of `rest`; empty at the end.
Range takeWord(const std::string& text, Range& rest) {
  rest = trimmed(text, rest);
  Range word{rest.begin, rest.begin};
  while (word.end < rest.end && kBlanks.find(text[word.end]) == kBlanks.npos) ++word.end;
  rest.begin = word.end;
  return word;
}

/// Takes the next line off the front of `rest`, with the lines that a backslash at its end continues.
Range takeStatement(Scan& scan, Range& rest, int& lines) {
  std::string& text = scan.obj.text;
  Range statement{rest.begin, rest.begin};
  for (lines = 1;; ++lines) {
    const std::size_t start = statement.end;
    std::size_t end = start;
    while (end < rest.end && text[end] != '\n' && text[end] != '\r') ++end;
    std::size_t next = end;
    if (next < rest.end) ++next;
    if (next < rest.end && text[end] == '\r' && text[next] == '\n') ++next;
    rest.begin = next;
    statement.end = end;
    const Range words = trimmed(text, statement);
    const bool continued =
        next > end && words.begin < words.end && text[words.begin] != '#' && text[words.end - 1] == '\\';
    if (!continued) return words;
    blankOut(text, {words.end - 1, next});
    statement.end = next;
  }
}

void checkNumber(const Scan& scan, std::string_view word) {
  const std::string_view digits = word.substr(word.starts_with('+') ? 1 : 0);
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc() || end != digits.data() + digits.size() ||
      !(std::abs(value) <= std::numeric_limits<float>::max())) {
    scan.fail(fmt::format("'{}' is not a finite number", forMessage(word)));
  }
}

/// v, vn, vt: at least `required` numbers, and the next up to `optional` too where they are there.
void checkNumbers(Scan& scan, Range rest, List& list, int required, int optional) {
  int found = 0;
  for (; found < required + optional; ++found) {
    const Range word = takeWord(scan.obj.text, rest);
    if (word.begin == word.end) break;
    checkNumber(scan, scan.view(word));
  }
  if (found < required) scan.fail(fmt::format("a {} needs {} numbers, found {}", list.name, required, found));
  ++list.count;
}

/// One index of a face: counted from 1, or from the end where negative.
void checkIndex(Scan& scan, std::string_view word, List& list) {
  std::int64_t index = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), index);
  if (error != std::errc() || end != word.data() + word.size()) {
    scan.fail(fmt::format("'{}' is not an index of a face", forMessage(word)));
  }
  if (index == 0) scan.fail("index 0 in a face, but indices start at 1");
  if (index < -list.count) {
    scan.fail(
        fmt::format("a face refers to {} {}, but only {} come before it", list.name, index, list.count));
  }
  if (index > list.furthest) {
    list.furthest = index;
    list.furthest_line = scan.line;
  }
}

/// A corner is v, v/vt, v//vn or v/vt/vn. Slashes at its end, which some programs write, are blanked out.
void checkCorner(Scan& scan, Range corner) {
  while (corner.end > corner.begin && scan.obj.text[corner.end - 1] == '/') {
    scan.obj.text[--corner.end] = ' ';
  }
  std::string_view rest = scan.view(corner);
  for (int i = 0;; ++i) {
    if (i == 3) scan.fail("a corner of a face has more than 3 indices");
    const std::size_t slash = rest.find('/');
    const std::string_view word = rest.substr(0, slash);
    if (!(i == 1 && word.empty())) checkIndex(scan, word, scan.lists[i]);
    if (slash == rest.npos) return;
    rest.remove_prefix(slash + 1);
  }
}

void checkFace(Scan& scan, Range rest) {
  for (int corners = 0;; ++corners) {
    const Range corner = takeWord(scan.obj.text, rest);
    if (corner.begin == corner.end) return;
    if (corners == kMostCorners) scan.fail(fmt::format("a face has more than {} corners", kMostCorners));
    checkCorner(scan, corner);
  }
}

void scanStatement(Scan& scan, Range statement) {
  std::string& text = scan.obj.text;
  Range rest = statement;
  const Range word = takeWord(text, rest);
  const std::string_view keyword = scan.view(word);
  if (keyword == "usemtl") {
    const Range name = trimmed(text, rest);
    for (std::size_t i = name.begin; i < name.end; ++i) {
      if (kBlanks.find(text[i]) != kBlanks.npos) text[i] = kNameBlank;
    }
    return;
  }
  if (keyword == "mtllib") {
    scan.obj.material_files.emplace_back(scan.view(trimmed(text, rest)));
    text[word.begin] = '#';
    return;
  }
  const std::size_t comment = scan.view(rest).find('#');
  if (comment != std::string_view::npos) {
    blankOut(text, {rest.begin + comment, rest.end});
    rest.end = rest.begin + comment;
  }
  if (keyword == "v") {
    checkNumbers(scan, rest, scan.lists[0], 3, 0);
  } else if (keyword == "vt") {
    checkNumbers(scan, rest, scan.lists[1], 1, 1);
  } else if (keyword == "vn") {
    checkNumbers(scan, rest, scan.lists[2], 3, 0);
  } else if (keyword == "f") {
    checkFace(scan, rest);
  } else if (keyword == "s") {
    scan.obj.has_smoothing = true;
    const Range group = takeWord(text, rest);
    if (scan.view(group) == "on") text.replace(group.begin, 2, "1 ");
  } else if (word.begin < word.end) {
    text[word.begin] = '#';
  }
}

}  // namespace

ObjText readObjText(const std::string& path) {
  ObjText obj;
  obj.text = readFile(path);
  if (obj.text.find('\0') != std::string::npos) {
    throw InputError(path +
                     ": holds zero bytes, expected OBJ as ASCII or UTF-8 text (UTF-16 is not supported)");
  }
  if (obj.text.starts_with("\xef\xbb\xbf")) obj.text.replace(0, 3, "   ");

  Scan scan{path, obj};
  for (Range rest{0, obj.text.size()}; rest.begin < rest.end;) {
    int lines = 1;
    scanStatement(scan, takeStatement(scan, rest, lines));
    scan.line += lines;
  }
  for (const List& list : scan.lists) {
    if (list.furthest <= list.count) continue;
    scan.line = list.furthest_line;
    scan.fail(fmt::format("a face refers to {} {}, but the file has only {}", list.name, list.furthest,
                          list.count));
  }
  return obj;
}

}  // namespace luciole
