#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <unordered_map>

#include "luciole/scene.hpp"
#include "scene/json/json_fields.hpp"
#include "scene/light_groups.hpp"
#include "scene/lights/light_field.hpp"

namespace luciole {

/// The files that lights name. Each is read once, however many lights name it.
struct LightFiles {
  SearchFolders where;
  std::unordered_map<std::string, std::shared_ptr<const LightProfile>> profiles = {};  ///< by their names
  std::map<std::tuple<const LightProfile*, double, double, double>, std::int32_t> luminaires =
      {};  ///< of the scene, by profile and Luminaire::up
};

/// Reads an element of "lights", and its motion, into the scene. A light that is switched off ("enabled":
/// false) is checked but not added. Environments and shining faces are added to the scene's sources. groups,
/// files: of the scene. Throws InputError.
void readLight(const JsonNode& node, LightGroupNumbers& groups, LightFiles& files, Scene& scene);

/// Reads an element of "light_fields", and the file that it may name, found as by findFile(). Throws
/// InputError.
LightField readLightField(const JsonNode& node, const SearchFolders& where, LightGroupNumbers& groups,
                          Scene& scene);

}  // namespace luciole
