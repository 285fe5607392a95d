#pragma once

#include <functional>
#include <initializer_list>
#include <string_view>

#include "luciole/animation.hpp"
#include "scene/json/json_fields.hpp"

namespace luciole {

/// Whether a camera, light or object moves: it has "keys". Throws InputError unless they are an array of one
/// or more objects with rising "frame" and no other members than `members`, and "interpolation" is valid. The
/// members' values are not checked.
bool hasKeys(const JsonNode& node, std::initializer_list<std::string_view> members);

/// Reads the value of a member of a key.
using ReadValue = std::function<glm::dvec4(const JsonNode&)>;

/// The curve of a member, from the keys that name it; without keys where none does. `node` must have passed
/// hasKeys().
Curve readMotion(const JsonNode& node, std::string_view member, const ReadValue& read);

/// Calls check(frame) for each key. Throws InputError at the key where it returns a message.
void checkPoses(const JsonNode& node, const std::function<std::string(double frame)>& check);

}  // namespace luciole
