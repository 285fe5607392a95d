#include "scene/json/light_list.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <iterator>
#include <string_view>

#include "base/error.hpp"
#include "base/text_file.hpp"
#include "scene/json/json_fields.hpp"
#include "scene/lights/light_field.hpp"

namespace luciole {
namespace {

constexpr std::string_view kNames[]{"x", "y", "z", "r", "g", "b", "range"};
constexpr std::size_t kFields = std::size(kNames);

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

/// The line's fields; those that are left out are empty.
std::size_t splitFields(std::string_view text, std::string_view (&fields)[kFields], const Line& line) {
  const std::size_t count = 1 + static_cast<std::size_t>(std::count(text.begin(), text.end(), ','));
  if (count != kFields && count != kFields - 1)
    line.refuse(fmt::format("expected x,y,z,r,g,b,range, got {} fields", count));
  for (std::string_view& field : fields) field = takeUntil(',', text);
  return count;
}

bool isHeader(const std::string_view (&fields)[kFields], std::size_t count) {
  return std::equal(fields, fields + count, kNames);
}

double readField(std::size_t i, std::string_view text, double lowest, const Line& line) {
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool is_number = error == std::errc() && end == text.data() + text.size();
  if (!is_number || !(number >= lowest && number <= kLargestNumber)) {
    line.refuse(fmt::format("{}: expected a number from {} to {}, got \"{}\"", kNames[i], lowest,
                            kLargestNumber, forMessage(text)));
  }
  return number;
}

Light readLine(const std::string_view (&fields)[kFields], const Line& line) {
  Light light;
  for (int i = 0; i < 3; ++i) light.position[i] = readField(std::size_t(i), fields[i], -kLargestNumber, line);
  for (int i = 0; i < 3; ++i)
    light.diffuse[i] = static_cast<float>(readField(std::size_t(3 + i), fields[3 + i], 0, line));
  light.specular = light.diffuse;
  if (!fields[6].empty()) light.range = static_cast<float>(readField(6, fields[6], 1 / kLargestNumber, line));
  return light;
}

}  // namespace

std::vector<Light> readLightList(const std::string& path, std::optional<std::uint64_t> count) {
  const std::string bytes = readFile(path);
  std::string_view text = bytes;
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);  // spreadsheets write a byte order mark
  std::vector<Light> lights;
  bool may_be_header = true;
  Line line{path, 0};
  while (!text.empty() && lights.size() < count.value_or(kMostLights + 1)) {
    ++line.number;
    const std::string_view words = takeUntil('\n', text);
    if (words.empty() || words.front() == '#') continue;
    std::string_view fields[kFields];
    const std::size_t field_count = splitFields(words, fields, line);
    if (!(may_be_header && isHeader(fields, field_count))) lights.push_back(readLine(fields, line));
    may_be_header = false;
  }
  if (lights.size() > kMostLights)
    line.refuse(fmt::format("a scene may have {} lights at most", kMostLights));
  if (count && lights.size() < *count)
    throw InputError(fmt::format("{}: {} lights, expected {} or more", path, lights.size(), *count));
  return lights;
}

}  // namespace luciole
