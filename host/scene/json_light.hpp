#pragma once

#include <optional>

#include "scene/json_fields.hpp"
#include "scene/light_field.hpp"
#include "scene/scene.hpp"

namespace luciole {

/// Reads an element of "lights"; none if it is switched off ("enabled": false), though it is checked all the
/// same.
std::optional<Light> readLight(const JsonNode& node);

/// Reads an element of "light_fields".
LightField readLightField(const JsonNode& node);

}  // namespace luciole
