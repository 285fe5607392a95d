#pragma once

#include <string>
#include <vector>

#include "luciole/scene.hpp"

namespace luciole {

/// Appends everything the file's default scene shows to `scene`: meshes, materials, textures, objects, lights
/// and cameras. Reads .gltf and .glb. Meshes deform by morph targets and skins. Throws InputError; its
/// message names a required extension that is not supported. An object may be mirrored: then the determinant
/// of its transform is negative, and in world space the fronts of its triangles are clockwise. Files that
/// aren't where it says are looked for in the folders `search`, too (see findFile).
void loadGltf(const std::string& path, Scene& scene, const GltfChoice& choice = {},
              const std::vector<std::string>& search = {});

}  // namespace luciole
