#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "tools/view/server.hpp"

// Reads what the page asks, and writes what it is answered.
namespace luciole {

/// The object that a request's body is. Throws InputError.
nlohmann::json requestIn(const std::string& body);

/// The member of an object; null where it has none of that name.
const nlohmann::json& memberIn(const nlohmann::json& object, const char* name);

/// A finite number within bounds. Throws InputError about the member `name`.
double numberIn(const nlohmann::json& json, double low, double high, const std::string& name);

/// A text, "" of null. Throws InputError about the member `name`.
std::string textIn(const nlohmann::json& json, const std::string& name);

[[noreturn]] void refuseMember(const std::string& name);

Answer jsonAnswer(nlohmann::json json);

/// A picture and what is told of it: a 32-bit length, so many bytes of JSON, and the picture.
Answer pictureAnswer(const nlohmann::json& about, const std::string& picture);

}  // namespace luciole
