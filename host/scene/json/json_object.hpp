#pragma once

#include <string>

#include "luciole/scene.hpp"
#include "scene/json/json_fields.hpp"

namespace luciole {

/// Reads "materials" and "objects" of a Luciole scene with the meshes and textures that they name, each file
/// once. top: the whole file. Files are found as by findFile(). Missing pictures go into
/// Scene::missing_textures. Throws InputError.
void readObjects(const JsonNode& top, const SearchFolders& where, Scene& scene);

/// Sets the members of a material that an element of "materials" has. An ambient coefficient that equals the
/// diffuse one stays equal. Textures are added, not decoded. Throws InputError.
void readMaterial(const JsonNode& node, const SearchFolders& where, Scene& scene, Material& material);

}  // namespace luciole
