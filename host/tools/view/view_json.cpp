#include "tools/view/view_json.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <utility>

#include "base/dump_utf8.hpp"
#include "luciole/error.hpp"

namespace luciole {

nlohmann::json requestIn(const std::string& body) {
  nlohmann::json json = nlohmann::json::parse(body, nullptr, false);
  if (!json.is_object()) throw InputError("request: expected a JSON object");
  return json;
}

const nlohmann::json& memberIn(const nlohmann::json& object, const char* name) {
  static const nlohmann::json kNone;
  const auto found = object.find(name);
  return found == object.end() ? kNone : *found;
}

double numberIn(const nlohmann::json& json, double low, double high, const std::string& name) {
  if (!json.is_number()) refuseMember(name);
  const double number = json.get<double>();
  if (!(number >= low && number <= high)) refuseMember(name);
  return number;
}

std::string textIn(const nlohmann::json& json, const std::string& name) {
  if (json.is_null()) return "";
  if (!json.is_string()) refuseMember(name);
  return json.get<std::string>();
}

void refuseMember(const std::string& name) {
  throw InputError(fmt::format("request: {}: not as the page sends it", name));
}

Answer jsonAnswer(nlohmann::json json) { return {.body = dumpUtf8(std::move(json))}; }

Answer pictureAnswer(const nlohmann::json& about, const std::string& picture) {
  const std::string json = dumpUtf8(about);
  const auto length = std::uint32_t(json.size());
  std::string body;
  for (int shift = 0; shift < 32; shift += 8) body += char(length >> shift & 255);
  return {.type = "application/octet-stream", .body = body + json + picture};
}

}  // namespace luciole
