#pragma once

#include <string>

#include "scene/json/json_fields.hpp"
#include "scene/scene.hpp"

namespace luciole {

/// Reads "materials" and "objects" of a Luciole scene, `top` being the whole file, with the meshes and
/// textures they name, each loaded once however often it is named. Their files are
/// looked for as findFile() does. Missing pictures are noted in Scene::missing_textures. Throws InputError.
void readObjects(const JsonNode& top, const SearchFolders& where, Scene& scene);

}  // namespace luciole
