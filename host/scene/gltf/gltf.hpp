#pragma once

#include <string>
#include <vector>

#include "luciole/scene.hpp"

namespace luciole {

/// Appends the file's default scene to `scene`: meshes, materials, textures, objects, lights, cameras and
/// animation. Reads .gltf and .glb. Throws InputError; its message names a required extension that is not
/// supported. An object may be mirrored: then the determinant of its transform is negative, and in world
/// space the fronts of its triangles are clockwise. search: more folders for files (see findFile).
void loadGltf(const std::string& path, Scene& scene, const GltfChoice& choice = {},
              const std::vector<std::string>& search = {});

}  // namespace luciole
