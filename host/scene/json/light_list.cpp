#include "scene/json/light_list.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <iterator>
#include <string_view>

#include "base/text_file.hpp"
#include "luciole/error.hpp"
#include "scene/json/json_fields.hpp"
#include "scene/lights/light_field.hpp"

namespace luciole {
namespace {

/// What a column holds; its place in kColumns.
enum ListColumn : std::size_t {
  kX,
  kRed = kX + 3,
  kRange = kRed + 3,
  kConstant,
  kDx = kConstant + 3,
  kCutoff = kDx + 3,
  kExponent,
  kInnerCone,
  kOuterCone,
};

struct ColumnRule {
  std::string_view name;
  double lowest, highest;
};
constexpr ColumnRule kColumns[]{{"x", -kLargestNumber, kLargestNumber},
                                {"y", -kLargestNumber, kLargestNumber},
                                {"z", -kLargestNumber, kLargestNumber},
                                {"r", 0, kLargestNumber},
                                {"g", 0, kLargestNumber},
                                {"b", 0, kLargestNumber},
                                {"range", 1 / kLargestNumber, kLargestNumber},
                                {"constant", 0, kLargestNumber},
                                {"linear", 0, kLargestNumber},
                                {"quadratic", 0, kLargestNumber},
                                {"dx", -kLargestNumber, kLargestNumber},
                                {"dy", -kLargestNumber, kLargestNumber},
                                {"dz", -kLargestNumber, kLargestNumber},
                                {"cutoff", 0, 180},
                                {"exponent", 0, 128},
                                {"inner_cone", 0, 90},
                                {"outer_cone", 0, 90}};
constexpr std::size_t kColumnCount = std::size(kColumns);
static_assert(kColumnCount == kOuterCone + 1);

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

/// Removes the text up to the next separator, or all of it, from the front. Returns it without blanks.
std::string_view takeUntil(char separator, std::string_view& text) {
  const std::size_t end = text.find(separator);
  const std::string_view part = trimmed(text.substr(0, end));
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  return part;
}

struct Line {
  const std::string& path;
  std::size_t number;
  [[noreturn]] void refuse(const std::string& what) const {
    throw InputError(fmt::format("{}: line {}: {}", path, number, what));
  }
};

/// The columns of a file, in its order: kColumns without a header.
struct Columns {
  std::vector<std::size_t> places{kX, kX + 1, kX + 2, kRed, kRed + 1, kRed + 2, kRange};
  bool is_named = false;

  bool has(std::size_t column) const {
    return std::find(places.begin(), places.end(), column) != places.end();
  }
};

/// Whether the line names columns: no number begins with a letter.
bool isHeader(std::string_view words) { return std::isalpha(static_cast<unsigned char>(words.front())) != 0; }

Columns readHeader(std::string_view words, const Line& line) {
  Columns columns{.places = {}, .is_named = true};
  while (!words.empty()) {
    const std::string_view name = takeUntil(',', words);
    const auto rule = std::find_if(std::begin(kColumns), std::end(kColumns),
                                   [&](const ColumnRule& one) { return one.name == name; });
    if (rule == std::end(kColumns)) {
      std::vector<std::string_view> names;
      for (const ColumnRule& one : kColumns) names.push_back(one.name);
      line.refuse(
          fmt::format("column \"{}\": expected names of {}", forMessage(name), fmt::join(names, ", ")));
    }
    if (columns.has(std::size_t(rule - kColumns)))
      line.refuse(fmt::format("column \"{}\" is there twice", name));
    columns.places.push_back(std::size_t(rule - kColumns));
  }
  const std::size_t place = columns.has(kDx) && !columns.has(kX) ? kDx : kX;
  for (const std::size_t first : {place, std::size_t(kRed)})
    for (std::size_t column = first; column < first + 3; ++column)
      if (!columns.has(column))
        line.refuse(
            fmt::format("no column \"{}\", expected x, y, z, r, g, b and others", kColumns[column].name));
  return columns;
}

/// A line's fields by their columns; those that are left out are empty.
using Fields = std::array<std::string_view, kColumnCount>;

Fields splitFields(std::string_view text, const Columns& columns, const Line& line) {
  const std::size_t count = 1 + static_cast<std::size_t>(std::count(text.begin(), text.end(), ','));
  const std::size_t wanted = columns.places.size();
  if (columns.is_named && count != wanted)
    line.refuse(fmt::format("expected {} fields as in the first line, got {}", wanted, count));
  if (count != wanted && count != wanted - 1)
    line.refuse(fmt::format("expected x,y,z,r,g,b,range, got {} fields", count));
  Fields fields;
  for (const std::size_t place : columns.places) fields[place] = takeUntil(',', text);
  return fields;
}

double readField(std::size_t column, const Fields& fields, const Line& line) {
  const auto& [name, lowest, highest] = kColumns[column];
  const std::string_view text = fields[column];
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool is_number = error == std::errc() && end == text.data() + text.size();
  if (!is_number || !(number >= lowest && number <= highest))
    line.refuse(fmt::format("{}: expected a number from {} to {}, got \"{}\"", name, lowest, highest,
                            forMessage(text)));
  return number;
}

/// The number of a field, or another one where it is empty.
double readField(std::size_t column, const Fields& fields, const Line& line, double otherwise) {
  return fields[column].empty() ? otherwise : readField(column, fields, line);
}

bool isAnyThere(const Fields& fields, std::size_t first, std::size_t count) {
  return std::any_of(fields.begin() + std::ptrdiff_t(first), fields.begin() + std::ptrdiff_t(first + count),
                     [](std::string_view field) { return !field.empty(); });
}

glm::dvec3 threeFields(std::size_t first, const Fields& fields, const Line& line) {
  return {readField(first, fields, line), readField(first + 1, fields, line),
          readField(first + 2, fields, line)};
}

void readFade(const Fields& fields, const Line& line, Light& light) {
  light.range = float(readField(kRange, fields, line, light.range));
  if (!isAnyThere(fields, kConstant, 3)) return;
  for (int i = 0; i < 3; ++i)
    light.attenuation[i] = float(readField(kConstant + std::size_t(i), fields, line, 0));
  if (light.attenuation == glm::vec3(0)) line.refuse("constant, linear and quadratic are all 0");
}

/// Makes a light with a place a spot, if its fields say one. With OpenGL's cutoff of 180° it stays a point
/// light.
void makeSpot(const Fields& fields, const Line& line, Light& light) {
  const bool has_cones = isAnyThere(fields, kInnerCone, 2);
  if (has_cones && isAnyThere(fields, kCutoff, 2))
    line.refuse("cutoff and exponent mean nothing beside inner_cone and outer_cone");
  if (has_cones) {
    const double inner = readField(kInnerCone, fields, line, 0),
                 outer = readField(kOuterCone, fields, line, 45);
    if (inner >= outer)
      line.refuse(fmt::format("inner_cone {} isn't smaller than outer_cone {}", inner, outer));
    light.falloff = SpotFalloff::kCone;
    light.inner_cone = glm::radians(inner);
    light.cutoff = glm::radians(outer);
  } else {
    const double cutoff = readField(kCutoff, fields, line, 180);
    if (cutoff > 90 && cutoff != 180)
      line.refuse(fmt::format("cutoff: expected degrees from 0 to 90, or 180, got {}", cutoff));
    const double exponent = readField(kExponent, fields, line, 0);
    if (cutoff == 180) return;
    light.exponent = float(exponent);
    light.cutoff = glm::radians(cutoff);
  }
  if (!isAnyThere(fields, kDx, 3)) line.refuse("a spot has a direction: dx, dy, dz are empty");
  light.kind = LightKind::kSpot;
}

Light readLine(const Fields& fields, const Line& line) {
  Light light;
  const bool has_direction = isAnyThere(fields, kDx, 3), has_place = isAnyThere(fields, kX, 3);
  if (has_direction) {
    const glm::dvec3 direction = threeFields(kDx, fields, line);
    const double longest = std::max({std::abs(direction.x), std::abs(direction.y), std::abs(direction.z)});
    if (longest == 0) line.refuse("dx, dy and dz are all 0, expected a direction");
    light.direction = glm::normalize(direction / longest);
  }
  const bool is_directional = has_direction && !has_place;
  if (!is_directional) light.position = threeFields(kX, fields, line);
  light.diffuse = light.specular = glm::vec3(threeFields(kRed, fields, line));
  if (is_directional) {
    light.kind = LightKind::kDirectional;
    for (std::size_t column = kRange; column < kColumnCount; ++column)
      if ((column < kDx || column >= kCutoff) && !fields[column].empty())
        line.refuse(fmt::format("{} means nothing for a light without x, y, z", kColumns[column].name));
    return light;
  }
  readFade(fields, line, light);
  makeSpot(fields, line, light);
  if (light.kind == LightKind::kPoint) light.direction = Light().direction;
  return light;
}

}  // namespace

std::vector<Light> readLightList(const std::string& path, std::optional<std::uint64_t> count) {
  const std::string bytes = readFile(path);
  std::string_view text = bytes;
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);  // spreadsheets write a byte order mark
  std::vector<Light> lights;
  Columns columns;
  bool may_be_header = true;
  Line line{path, 0};
  while (!text.empty() && lights.size() < count.value_or(kMostLights + 1)) {
    ++line.number;
    const std::string_view words = takeUntil('\n', text);
    if (words.empty() || words.front() == '#') continue;
    if (may_be_header && isHeader(words))
      columns = readHeader(words, line);
    else
      lights.push_back(readLine(splitFields(words, columns, line), line));
    may_be_header = false;
  }
  if (lights.size() > kMostLights)
    line.refuse(fmt::format("a scene may have {} lights at most", kMostLights));
  if (count && lights.size() < *count)
    throw InputError(fmt::format("{}: {} lights, expected {} or more", path, lights.size(), *count));
  return lights;
}

}  // namespace luciole
