#pragma once

#include <string>

#include "luciole/scene.hpp"
#include "scene/json/json_fields.hpp"

namespace luciole {

/// Reads "materials" and "objects" of a Luciole scene, `top` being the whole file, with the meshes and
/// textures they name, each loaded once however often it is named. Their files are
/// looked for as findFile() does. Missing pictures are noted in Scene::missing_textures. Throws InputError.
void readObjects(const JsonNode& top, const SearchFolders& where, Scene& scene);

/// Reads what a node of "materials" says over a material: what it doesn't say stays. An ambient coefficient
/// that equals the diffuse one follows it. Textures are added, and not decoded. Throws InputError.
void readMaterial(const JsonNode& node, const SearchFolders& where, Scene& scene, Material& material);

}  // namespace luciole
