#pragma once

#include <functional>
#include <initializer_list>
#include <string_view>

#include "scene/curve.hpp"
#include "scene/json/json_fields.hpp"

namespace luciole {

/// Whether a camera, light or object moves: it has "keys". Checks all of them but the values: an array of
/// one or more objects with rising "frame" and of the `members` only, and "interpolation".
bool hasKeys(const JsonNode& node, std::initializer_list<std::string_view> members);

/// Reads the value of a member of a key.
using ReadValue = std::function<glm::dvec4(const JsonNode&)>;

/// How a member moves, by those of the keys that name it; no key where none does. After hasKeys() only.
Curve readMotion(const JsonNode& node, std::string_view member, const ReadValue& read);

/// Calls check(frame) for each key; where that says what is wrong, refuses the key.
void checkPoses(const JsonNode& node, const std::function<std::string(double frame)>& check);

}  // namespace luciole
