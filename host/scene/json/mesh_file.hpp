#pragma once

#include <string>
#include <vector>

#include "luciole/scene.hpp"
#include "scene/gltf/gltf.hpp"

namespace luciole {

/// Whether the name ends in .obj, .gltf or .glb, case ignored.
bool isMeshFile(const std::string& path);

/// Appends a mesh file to `scene`, as loadObj or loadGltf do. An OBJ file has no choices. Throws InputError.
void loadMeshFile(const std::string& path, Scene& scene, const GltfChoice& choice = {},
                  const std::vector<std::string>& search = {});

/// Throws InputError where a choice is made for a file that isn't glTF.
void checkIsGltf(const std::string& path, const GltfChoice& choice);

/// A file name's extension with its dot, in lower case; "" where there is none.
std::string extensionOf(const std::string& path);

}  // namespace luciole
