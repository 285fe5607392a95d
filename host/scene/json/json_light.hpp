#pragma once

#include <string>

#include "luciole/scene.hpp"
#include "scene/json/json_fields.hpp"
#include "scene/light_groups.hpp"
#include "scene/lights/light_field.hpp"

namespace luciole {

/// Reads an element of "lights", and its motion, into the scene. A light that is switched off ("enabled":
/// false) is checked but not added. Environments and shining faces are added to the scene's sources. groups:
/// of the scene. Throws InputError.
void readLight(const JsonNode& node, const SearchFolders& where, LightGroupNumbers& groups, Scene& scene);

/// Reads an element of "light_fields", and the file that it may name, found as by findFile(). Throws
/// InputError.
LightField readLightField(const JsonNode& node, const SearchFolders& where, LightGroupNumbers& groups,
                          Scene& scene);

}  // namespace luciole
