#include "scene/json/json_fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <vector>

#include "base/did_you_mean.hpp"
#include "base/text_file.hpp"
#include "luciole/error.hpp"

namespace luciole {
namespace {

std::string placeOf(const JsonNode& node) {
  if (!node.parent) return "";
  const std::string outer = placeOf(*node.parent);
  if (node.index != JsonNode::kNoIndex) return fmt::format("{}[{}]", outer, node.index);
  const std::string key = forMessage(node.key);
  return outer.empty() ? key : outer + "." + key;
}

/// How a message names a value: "an object", "an array of 4", or the value itself.
std::string describe(const Json& json) {
  if (json.is_object()) return "an object";
  if (json.is_array()) return fmt::format("an array of {}", json.size());
  return forMessage(json.dump(-1, ' ', false, Json::error_handler_t::replace));
}

[[noreturn]] void expected(const JsonNode& node, const std::string& what) {
  refuse(node, fmt::format("expected {}, got {}", what, describe(*node.json)));
}

}  // namespace

std::string messageAt(const JsonNode& node, const std::string& what) {
  const JsonNode* root = &node;
  while (root->parent) root = root->parent;
  const std::string place = placeOf(node);
  return fmt::format("{}: {}{}{}", root->key, place, place.empty() ? "" : ": ", what);
}

void refuse(const JsonNode& node, const std::string& what) { throw InputError(messageAt(node, what)); }

void allowKeys(const JsonNode& object, std::span<const std::string_view> known) {
  needObject(object);
  for (const auto& [key, value] : object.json->items()) {
    if (std::find(known.begin(), known.end(), key) != known.end()) continue;
    std::string_view nearest;
    std::size_t distance = key.size() < 40 ? key.size() / 2 + 1 : 0;  // farther ones are no help
    for (std::string_view candidate : known) {
      const std::size_t d = distance == 0 ? 0 : editDistance(key, candidate);
      if (d < distance) {
        distance = d;
        nearest = candidate;
      }
    }
    refuse(object, fmt::format("unknown key \"{}\"", forMessage(key)) +
                       (nearest.empty() ? "" : fmt::format(" (did you mean \"{}\"?)", nearest)));
  }
}

void refuseKeys(const JsonNode& object, std::initializer_list<std::string_view> keys,
                const std::string& where) {
  for (std::string_view key : keys) {
    if (const auto node = find(object, key)) refuse(*node, "means nothing " + where);
  }
}

std::optional<JsonNode> find(const JsonNode& object, std::string_view key) {
  needObject(object);
  const auto it = object.json->find(std::string(key));
  if (it == object.json->end()) return std::nullopt;
  return JsonNode{&*it, &object, key, JsonNode::kNoIndex};
}

JsonNode need(const JsonNode& object, std::string_view key) {
  const auto node = find(object, key);
  if (!node) refuse(object, fmt::format("\"{}\" is missing", key));
  return *node;
}

void needObject(const JsonNode& node) {
  if (!node.json->is_object()) expected(node, "an object");
}

void needArray(const JsonNode& node) {
  if (!node.json->is_array()) expected(node, "an array");
}

JsonNode element(const JsonNode& array, std::size_t index) {
  return {&(*array.json)[index], &array, {}, index};
}

double readNumber(const JsonNode& node) {
  if (!node.json->is_number()) expected(node, "a finite number");
  const double number = node.json->get<double>();
  if (!(std::abs(number) <= kLargestNumber)) expected(node, "a number from -1e18 to 1e18");
  return number;
}

double readNumber(const JsonNode& node, double low, double high) {
  const double number = readNumber(node);
  if (!(number >= low && number <= high)) {
    expected(node, high == kLargestNumber ? fmt::format("a number of {} or more", low)
                                          : fmt::format("a number from {} to {}", low, high));
  }
  return number;
}

double readPositive(const JsonNode& node) {
  const double number = readNumber(node);
  if (!(number >= 1 / kLargestNumber)) expected(node, "a number above 0 (1e-18 or more)");
  return number;
}

std::uint64_t readCount(const JsonNode& node, std::uint64_t largest) {
  const Json& json = *node.json;
  constexpr double kWholeDoubles = 9007199254740992.0;  // every whole number up to 2^53 is a double
  std::optional<std::uint64_t> count;
  // A parsed integer is signed if it has a minus: also -0.
  if (json.is_number_integer() && (json.is_number_unsigned() || json.get<std::int64_t>() == 0))
    count = json.get<std::uint64_t>();
  if (json.is_number_float()) {
    const double number = json.get<double>();
    if (number >= 0 && number <= kWholeDoubles && number == std::floor(number))
      count = static_cast<std::uint64_t>(number);
  }
  if (!count || *count > largest) expected(node, fmt::format("a whole number from 0 to {}", largest));
  return *count;
}

bool readBool(const JsonNode& node) {
  if (!node.json->is_boolean()) expected(node, "true or false");
  return node.json->get<bool>();
}

std::string readText(const JsonNode& node) {
  if (!node.json->is_string()) expected(node, "a text in quotes");
  return node.json->get<std::string>();
}

std::string pathOf(const JsonNode& node, const SearchFolders& where) {
  const std::string name = readText(node);
  return findFile(name, where)
      .value_or((std::filesystem::path(where.folder) / name).lexically_normal().string());
}

std::string faultOfPath(const std::string& path) {
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) return fmt::format("there is no file {}", path);
  if (std::filesystem::is_directory(path, ignored))
    return fmt::format("{} is a folder; expected a file", path);
  return "";
}

std::string readPath(const JsonNode& node, const SearchFolders& where) {
  const std::string path = pathOf(node, where), fault = faultOfPath(path);
  if (!fault.empty()) refuse(node, fault);
  return path;
}

glm::dvec3 readVector(const JsonNode& node) {
  if (!node.json->is_array() || node.json->size() != 3) expected(node, "an array of 3 numbers");
  return {readNumber(element(node, 0)), readNumber(element(node, 1)), readNumber(element(node, 2))};
}

glm::dvec3 readDirection(const JsonNode& node) {
  const glm::dvec3 vector = readVector(node);
  const double length = glm::length(vector);
  if (vector == glm::dvec3(0)) refuse(node, "expected a direction, got the zero vector");
  if (!(length >= 1 / kLargestNumber)) refuse(node, "expected a direction, got a vector shorter than 1e-18");
  return vector / length;
}

glm::vec3 readColor(const JsonNode& node) {
  if (node.json->is_number()) return glm::vec3(readNumber(node, 0, kLargestNumber));
  if (!node.json->is_array() || node.json->size() != 3) expected(node, "a colour: 3 numbers, or 1 for grey");
  glm::vec3 color;
  for (int i = 0; i < 3; ++i) color[i] = static_cast<float>(readNumber(element(node, i), 0, kLargestNumber));
  return color;
}

glm::vec3 readAttenuation(const JsonNode& node) {
  if (!node.json->is_array() || node.json->size() != 3) {
    expected(node, "an array of 3 numbers: constant, linear, quadratic");
  }
  glm::vec3 attenuation;
  for (int i = 0; i < 3; ++i)
    attenuation[i] = static_cast<float>(readNumber(element(node, i), 0, kLargestNumber));
  if (attenuation == glm::vec3(0)) refuse(node, "all 0: light would be infinite; expected one above 0");
  return attenuation;
}

}  // namespace luciole
