#include "scene/json/json_keys.hpp"

#include <fmt/format.h>

#include <vector>

namespace luciole {
namespace {

bool isSmooth(const JsonNode& node) {
  const auto n = find(node, "interpolation");
  if (!n) return false;
  const std::string name = readText(*n);
  if (name != "linear" && name != "smooth")
    refuse(*n, fmt::format("expected \"linear\" or \"smooth\", got {}", n->json->dump()));
  return name == "smooth";
}

}  // namespace

bool hasKeys(const JsonNode& node, std::initializer_list<std::string_view> members) {
  const auto keys = find(node, "keys");
  if (!keys) {
    refuseKeys(node, {"interpolation"}, "without keys");
    return false;
  }
  needArray(*keys);
  if (keys->json->empty()) refuse(*keys, "expected one key or more");
  std::vector<std::string_view> known{"frame"};
  known.insert(known.end(), members);
  double before = -2 * kLargestNumber;
  for (std::size_t i = 0; i < keys->json->size(); ++i) {
    const JsonNode key = element(*keys, i);
    allowKeys(key, known);
    const JsonNode frame = need(key, "frame");
    const double number = readNumber(frame);
    if (!(number > before)) refuse(frame, fmt::format("expected a frame after {}, got {}", before, number));
    if (key.json->size() == 1) refuse(key, "says nothing of its frame");
    before = number;
  }
  isSmooth(node);
  return true;
}

Curve readMotion(const JsonNode& node, std::string_view member, const ReadValue& read) {
  Curve curve;
  const JsonNode keys = need(node, "keys");
  for (std::size_t i = 0; i < keys.json->size(); ++i) {
    const JsonNode key = element(keys, i);
    const auto value = find(key, member);
    if (value) curve.keys.push_back({need(key, "frame").json->get<double>(), read(*value)});
  }
  if (!curve.keys.empty() && isSmooth(node)) makeSmooth(curve);
  return curve;
}

void checkPoses(const JsonNode& node, const std::function<std::string(double frame)>& check) {
  const JsonNode keys = need(node, "keys");
  for (std::size_t i = 0; i < keys.json->size(); ++i) {
    const JsonNode key = element(keys, i);
    const std::string fault = check(need(key, "frame").json->get<double>());
    if (!fault.empty()) refuse(key, fault);
  }
}

}  // namespace luciole
