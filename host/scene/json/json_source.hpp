#pragma once

#include <cstdint>

#include "luciole/scene.hpp"
#include "scene/json/json_fields.hpp"

namespace luciole {

/// Whether an element of "lights" has a type that many lights take the place of.
bool isSource(const JsonNode& light);

/// Reads an environment, rectangle or disc of a group of lights. Throws InputError.
void readSource(const JsonNode& node, const SearchFolders& where, std::uint32_t group, Scene& scene);

/// Reads "emits" of an object or a material: how many lights; `true` is as many as a face has.
std::uint32_t readEmits(const JsonNode& node);

}  // namespace luciole
