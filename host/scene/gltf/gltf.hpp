#pragma once

#include <string>

#include "scene/scene.hpp"

namespace luciole {

/// Appends everything the file's default scene shows to `scene`: meshes, materials, textures, objects, lights
/// and cameras. Reads .gltf and .glb. Throws InputError; a required extension that is not supported is named.
/// An object may be mirrored: the determinant of its transform is then negative, and in the world its
/// triangles' fronts are clockwise.
void loadGltf(const std::string& path, Scene& scene);

}  // namespace luciole
