#pragma once

#include <string>

#include "scene/scene.hpp"

namespace luciole {

/// Appends everything the file's default scene shows to `scene`: meshes, materials, textures, objects, lights
/// and cameras. Reads .gltf and .glb. Throws InputError; its message names a required extension that is not
/// supported. An object may be mirrored: then the determinant of its transform is negative, and in world
/// space the fronts of its triangles are clockwise.
void loadGltf(const std::string& path, Scene& scene);

}  // namespace luciole
