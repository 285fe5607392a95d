#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "base/utf8.hpp"

namespace luciole {

/// Makes all texts and keys of a JSON value UTF-8, by utf8Of().
template <class Json>
void makeUtf8(Json& json) {
  if (json.is_string()) {
    if (auto& text = json.template get_ref<std::string&>(); !isUtf8(text)) text = utf8Of(text);
  } else if (json.is_array()) {
    for (Json& element : json) makeUtf8(element);
  } else if (json.is_object()) {
    Json other = Json::object();
    bool renamed = false;
    for (const auto& [key, value] : json.items()) renamed |= !isUtf8(key);
    for (const auto& [key, value] : json.items()) {
      makeUtf8(value);
      if (renamed) other[utf8Of(key)] = std::move(value);
    }
    if (renamed) json = std::move(other);
  }
}

/// The text of a JSON value whose strings may be invalid UTF-8, which Json::dump() refuses. `indent`: as of
/// Json::dump().
template <class Json>
std::string dumpUtf8(Json json, int indent = -1) {
  makeUtf8(json);
  return json.dump(indent);
}

}  // namespace luciole
