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

#include "base/large_pages.hpp"
#include "base/text_file.hpp"
#include "luciole/error.hpp"
#include "scene/obj/obj_text.hpp"

namespace luciole {
namespace {

/// What is repaired or left out.
enum Repair {
  kUvNoNumber,
  kNormalNoNumber,
  kColorNoNumber,
  kNoSuchUv,
  kNoSuchNormal,
  kFewCorners,
  kNoFace,
  kUnknown
};
struct RepairWords {
  const char* kind;
  const char* outcome;
  bool is_fault = true;  ///< of the file, rather than what isn't drawn
};
constexpr RepairWords kRepairs[] = {{"texture coordinate without number", "taken as 0"},
                                    {"normal without number", "taken from the faces"},
                                    {"vertex colour without number", "taken as white"},
                                    {"missing texture coordinate", "drawn without"},
                                    {"missing normal", "drawn without"},
                                    {"face of few corners", "left out"},
                                    {"points, lines and curves", "left out", false},
                                    {"unknown statement", "left out", false}};

/// The faults of one kind: how many, and the first.
struct Repaired {
  std::int64_t count = 0;
  int line = 0;
  std::string what = {};
};

/// One of the three numbered lists of an OBJ file, and the largest index of it that a face uses.
struct List {
  const char* name;
  std::int64_t before = 0;                                        ///< how many come before the part
  std::int64_t count = 0;                                         ///< how many the part has so far
  std::int64_t total = std::numeric_limits<std::int64_t>::max();  ///< how many the file has, once known
  std::int64_t furthest = 0;
  int furthest_line = 0;
};

/// What is wrong with a part, which isn't read any further.
struct Fault {
  int line;
  std::string what;
};

constexpr glm::dvec3 kNoColor(-1);

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
  std::array<Repaired, std::size(kRepairs)> repaired = {};

  /// Counts a fault; `say` tells what it is.
  template <class Say>
  void repair(Repair kind, const Say& say) {
    if (repaired[kind].count++ == 0) repaired[kind] = {1, line, say()};
  }
  [[noreturn]] void fail(const std::string& what) const { throw Fault{line, what}; }
};

glm::vec3 takePosition(Reader& reader, std::string_view& rest) {
  glm::vec3 position;
  for (int i = 0; i < 3; ++i) {
    const std::string_view word = takeWord(rest);
    if (word.empty()) reader.fail(fmt::format("a vertex needs 3 numbers, found {}", i));
    const std::optional<float> number = finiteNumber(word);
    if (!number) reader.fail(fmt::format("'{}' is not a finite number", forMessage(word)));
    position[i] = *number;
  }
  ++reader.positions.count;
  return position;
}

/// The colour behind a position, if there is one: three numbers, or four of which the first is a weight.
void readColor(Reader& reader, std::string_view rest) {
  std::array<std::string_view, 4> words;
  int count = 0;
  while (count < 4 && !(words[count] = takeWord(rest)).empty()) ++count;
  if (count < 3) return;
  glm::dvec3 color(0);
  for (int i = 0; i < 3; ++i) {
    const std::string_view word = words[count - 3 + i];
    const std::optional<double> number = finiteDouble(word);
    if (!number) {
      reader.repair(kColorNoNumber, [&] {
        return fmt::format("'{}' in a vertex's colour is not a finite number", forMessage(word));
      });
      return;
    }
    color[i] = std::max(*number, 0.0);
  }
  ObjFile& file = reader.file;
  file.colors.resize(file.positions.size() - 1, kNoColor);
  file.colors.push_back(color);
}

/// v is 0 where it is missing.
glm::vec2 takeUv(Reader& reader, std::string_view rest) {
  glm::vec2 uv(0);
  for (int i = 0; i < 2; ++i) {
    const std::string_view word = takeWord(rest);
    if (word.empty() && i == 1) break;
    const std::optional<float> number = finiteNumber(word);
    if (!number)
      reader.repair(kUvNoNumber, [&] {
        return fmt::format("'{}' of a texture coordinate is not a finite number", forMessage(word));
      });
    uv[i] = number.value_or(0.0f);
  }
  ++reader.uvs.count;
  return uv;
}

glm::vec3 takeNormal(Reader& reader, std::string_view rest) {
  ++reader.normals.count;
  glm::vec3 normal(0);
  for (int i = 0; i < 3; ++i) {
    const std::string_view word = takeWord(rest);
    const std::optional<float> number = finiteNumber(word);
    if (!number) {
      reader.repair(kNormalNoNumber,
                    [&] { return fmt::format("'{}' of a normal is not a finite number", forMessage(word)); });
      return glm::vec3(0);
    }
    normal[i] = *number;
  }
  return normal;
}

/// Converts an index from 1, or a negative one from the end, to one from 0. It may refer to what comes later
/// in the file. -1 where the list doesn't have it and that can be repaired.
int readIndex(Reader& reader, std::string_view word, List& list, std::optional<Repair> repair) {
  std::int64_t index = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), index);
  if (error != std::errc() || end != word.data() + word.size()) {
    reader.fail(fmt::format("'{}' is not an index of a face", forMessage(word)));
  }
  const auto refuse = [&](const auto& say) {
    if (!repair) reader.fail(say());
    reader.repair(*repair, say);
    return -1;
  };
  if (index == 0)
    return refuse(
        [&] { return fmt::format("index 0 of a {} in a face, but indices start at 1", list.name); });
  const std::int64_t count = list.before + list.count;
  if (index < 0 && !reader.knows_before) {
    reader.counts_back = true;
    return -1;
  }
  if (index < -count)
    return refuse([&] {
      return fmt::format("a face refers to {} {}, but only {} come before it", list.name, index, count);
    });
  if (index > list.total)
    return refuse([&] {
      return fmt::format("a face refers to {} {}, but the file has only {}", list.name, index, list.total);
    });
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
  corner.position = readIndex(reader, words[0], reader.positions, std::nullopt);
  if (!words[1].empty()) corner.uv = readIndex(reader, words[1], reader.uvs, kNoSuchUv);
  if (!words[2].empty()) corner.normal = readIndex(reader, words[2], reader.normals, kNoSuchNormal);
  return corner;
}

void readFace(Reader& reader, std::string_view rest) {
  ObjFile& file = reader.file;
  ObjFace face{file.corners.size(), 0, static_cast<int>(file.material_names.size()) - 1,
               static_cast<int>(file.parts.size()) - 1, reader.smoothing.value_or(0)};
  for (std::string_view word; !(word = takeWord(rest)).empty(); ++face.corner_count)
    file.corners.push_back(readCorner(reader, word));
  if (face.corner_count >= 3) {
    file.faces.push_back(face);
    return;
  }
  file.corners.resize(face.first_corner);
  reader.repair(kFewCorners, [&] {
    return fmt::format("a face has {} {}, expected 3 or more", face.corner_count,
                       face.corner_count == 1 ? "corner" : "corners");
  });
}

void readPartName(Reader& reader, std::string_view rest, bool is_object) {
  std::string name;
  rest = nameWithoutComment(trimmed(rest));
  for (std::string_view word; !(word = takeWord(rest)).empty(); name += word)
    if (!name.empty()) name += ' ';
  reader.file.parts.push_back({std::move(name), is_object});
}

/// "on" is group 1; "off" and other words are no group. Numbers beyond `unsigned` are one group.
void readSmoothing(Reader& reader, std::string_view group) {
  reader.has_smoothing = true;
  if (group.empty()) return;
  if (!reader.smoothing) reader.faces_before_smoothing = reader.file.faces.size();
  unsigned number = isKeyword(group, "on");
  const auto [end, error] = std::from_chars(group.data(), group.data() + group.size(), number);
  reader.smoothing = error == std::errc::result_out_of_range ? ~0u : number;
}

/// Elements that are no faces, and statements that change nothing here: of curves, levels of detail and ways
/// of drawing.
constexpr std::string_view kNoFaces[] = {"p", "l", "curv", "curv2", "surf", "bsp", "bzp", "cdc", "cdp"};
constexpr std::string_view kUnread[] = {"vp",       "cstype", "deg",        "bmat",     "step",  "parm",
                                        "trim",     "hole",   "scrv",       "sp",       "end",   "con",
                                        "mg",       "lod",    "res",        "bevel",    "ctech", "c_interp",
                                        "d_interp", "stech",  "shadow_obj", "trace_obj"};

/// Statements other than those of points and faces.
void readOther(Reader& reader, std::string_view keyword, std::string_view rest) {
  ObjFile& file = reader.file;
  const auto is = [&](std::string_view lower) { return isKeyword(keyword, lower); };
  if (is("usemtl")) {
    file.material_names.emplace_back(trimmed(rest));
  } else if (is("mtllib")) {
    file.material_files.emplace_back(trimmed(rest));
  } else if (is("o") || is("g")) {
    readPartName(reader, rest, is("o"));
  } else if (is("s")) {
    std::string_view words = withoutComment(rest);
    readSmoothing(reader, takeWord(words));
  } else if (std::any_of(std::begin(kNoFaces), std::end(kNoFaces), is)) {
    file.has_lines = true;
    reader.repair(kNoFace, [&] { return fmt::format("'{}' makes no face", keyword); });
  } else if (!keyword.empty() && !keyword.starts_with('#') &&
             std::none_of(std::begin(kUnread), std::end(kUnread), is)) {
    reader.repair(kUnknown, [&] {
      return fmt::format("'{}' is no statement that is known here", forMessage(keyword));
    });
  }
}

void readStatement(Reader& reader, std::string_view rest) {
  const std::string_view keyword = takeWord(rest);
  ObjFile& file = reader.file;
  if (isKeyword(keyword, "v")) {
    rest = withoutComment(rest);
    file.positions.push_back(takePosition(reader, rest));
    if (!rest.empty()) readColor(reader, rest);
  } else if (isKeyword(keyword, "vt")) {
    file.uvs.push_back(takeUv(reader, withoutComment(rest)));
  } else if (isKeyword(keyword, "vn")) {
    file.normals.push_back(takeNormal(reader, withoutComment(rest)));
  } else if (isKeyword(keyword, "f") || isKeyword(keyword, "fo")) {
    readFace(reader, withoutComment(rest));
  } else {
    readOther(reader, keyword, rest);
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
  if (!reader.file.colors.empty()) reader.file.colors.resize(reader.file.positions.size(), kNoColor);
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

/// Reads those parts again that have negative indices, or refer to what the file doesn't have.
void readKnowingLists(std::vector<Reader>& parts) {
  for (std::size_t i = 1; i < parts.size(); ++i) {
    for (List Reader::*const list : kLists)
      (parts[i].*list).before = (parts[i - 1].*list).before + (parts[i - 1].*list).count;
  }
  std::array<std::int64_t, std::size(kLists)> totals{};
  for (std::size_t i = 0; i < totals.size(); ++i)
    totals[i] = (parts.back().*kLists[i]).before + (parts.back().*kLists[i]).count;
  tbb::parallel_for(std::size_t(0), parts.size(), [&](std::size_t i) {
    bool refers_past = false;  // which may be repaired, other than of positions
    for (std::size_t j = 1; j < totals.size(); ++j) refers_past |= (parts[i].*kLists[j]).furthest > totals[j];
    if (!parts[i].counts_back && !refers_past) return;
    Reader again{parts[i].text};
    for (std::size_t j = 0; j < totals.size(); ++j) {
      (again.*kLists[j]).before = (parts[i].*kLists[j]).before;
      if (j > 0) (again.*kLists[j]).total = totals[j];
    }
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
  std::int64_t furthest = 0, count = 0;
  int line = 0;
  lines = 0;
  for (const Reader& part : parts) {
    const List& list = part.positions;
    count += list.count;
    if (list.furthest > furthest) line = lines + list.furthest_line;
    furthest = std::max(furthest, list.furthest);
    lines += part.line - 1;
  }
  if (furthest > count)
    fail(line, fmt::format("a face refers to vertex {}, but the file has only {}", furthest, count));
}

/// What was repaired in all parts.
std::vector<Warning> repairsOf(const std::string& path, const std::vector<Reader>& parts) {
  std::vector<Warning> warnings;
  for (std::size_t kind = 0; kind < std::size(kRepairs); ++kind) {
    Repaired all;
    int lines = 0;
    for (const Reader& part : parts) {
      const Repaired& its = part.repaired[kind];
      if (all.count == 0) all = {0, lines + its.line, its.what};
      all.count += its.count;
      lines += part.line - 1;
    }
    if (all.count == 0) continue;
    warnings.push_back({fmt::format("{}: line {}: {}; {}{}", path, all.line, all.what, kRepairs[kind].outcome,
                                    all.count > 1 ? fmt::format(", as {} more are", all.count - 1) : ""),
                        kRepairs[kind].kind, kRepairs[kind].is_fault});
  }
  return warnings;
}

template <class T>
void append(std::vector<T>& list, std::vector<T>& whole) {
  whole.insert(whole.end(), std::make_move_iterator(list.begin()), std::make_move_iterator(list.end()));
  list = std::vector<T>();  // frees it
}

/// Puts the parts one after the other.
ObjFile joinParts(std::vector<Reader>& parts) {
  ObjFile whole;
  std::size_t positions = 0, uvs = 0, normals = 0, corners = 0, faces = 0;
  bool has_smoothing = false, has_colors = false;
  for (const Reader& part : parts) {
    positions += part.file.positions.size();
    uvs += part.file.uvs.size();
    normals += part.file.normals.size();
    corners += part.file.corners.size();
    faces += part.file.faces.size();
    has_smoothing |= part.has_smoothing;
    has_colors |= !part.file.colors.empty();
    whole.has_lines |= part.file.has_lines;
  }
  reserveLarge(whole.positions, positions);
  reserveLarge(whole.uvs, uvs);
  reserveLarge(whole.normals, normals);
  reserveLarge(whole.corners, corners);
  reserveLarge(whole.faces, faces);
  unsigned smoothing = 0;  // that the part before ends with
  for (Reader& part : parts) {
    ObjFile& file = part.file;
    for (std::size_t i = 0; i < file.faces.size(); ++i) {
      ObjFace& face = file.faces[i];
      face.first_corner += whole.corners.size();
      face.material += static_cast<int>(whole.material_names.size());
      face.part += static_cast<int>(whole.parts.size());
      if (i < part.faces_before_smoothing) face.smoothing = smoothing;
      if (!has_smoothing) face.smoothing = 1;
    }
    smoothing = part.smoothing.value_or(smoothing);
    if (has_colors) file.colors.resize(file.positions.size(), kNoColor);
    append(file.positions, whole.positions);
    append(file.colors, whole.colors);
    append(file.uvs, whole.uvs);
    append(file.normals, whole.normals);
    append(file.corners, whole.corners);
    append(file.faces, whole.faces);
    append(file.material_names, whole.material_names);
    append(file.material_files, whole.material_files);
    append(file.parts, whole.parts);
  }
  return whole;
}

}  // namespace

ObjFile readObjFile(const std::string& path, std::size_t part_bytes) {
  const std::string bytes = readFile(path);
  if (bytes.find('\0') != std::string::npos) {
    throw InputError(path +
                     ": holds zero bytes, expected OBJ as ASCII or UTF-8 text (UTF-16 is not supported)");
  }
  std::vector<Reader> parts = cutIntoParts(withoutMark(bytes), part_bytes);
  if (parts.empty()) return {};
  parts.front().knows_before = true;
  tbb::parallel_for(std::size_t(0), parts.size(), [&](std::size_t i) { readPart(parts[i]); });
  readKnowingLists(parts);
  checkParts(path, parts);
  std::vector<Warning> repairs = repairsOf(path, parts);
  ObjFile whole = joinParts(parts);
  whole.warnings = std::move(repairs);
  return whole;
}

}  // namespace luciole
