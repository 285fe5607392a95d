#pragma once

#include <string>

#include "scene/scene.hpp"

namespace luciole {

/// Whether the name ends in .obj, .gltf or .glb, case ignored.
bool isMeshFile(const std::string& path);

/// Appends such a file to `scene`, as loadObj or loadGltf do. Throws InputError.
void loadMeshFile(const std::string& path, Scene& scene);

/// The end of a file's name from its last dot on, in small letters.
std::string extensionOf(const std::string& path);

}  // namespace luciole
