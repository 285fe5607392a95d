#pragma once

#include <string>

#include "scene/json/json_fields.hpp"
#include "scene/scene.hpp"

namespace luciole {

/// Reads "materials" and "objects" of a Luciole scene, `top` being the whole file, with the meshes and
/// textures they name, each loaded once however often it is named. `folder`: where relative paths start;
/// empty: the current folder. Missing pictures are noted in Scene::missing_textures. Throws InputError.
void readObjects(const JsonNode& top, const std::string& folder, Scene& scene);

}  // namespace luciole
