#pragma once

#include <string>

#include "scene/json/json_fields.hpp"
#include "scene/lights/light_field.hpp"
#include "scene/scene.hpp"

namespace luciole {

/// Reads an element of "lights" and how it moves into the scene; nothing if it is switched off ("enabled":
/// false), though it is checked all the same.
void readLight(const JsonNode& node, Scene& scene);

/// Reads an element of "light_fields", and the file that it may name by a path relative to `folder`.
LightField readLightField(const JsonNode& node, const std::string& folder);

}  // namespace luciole
