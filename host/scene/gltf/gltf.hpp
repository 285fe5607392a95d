#pragma once

#include <string>

#include "scene/scene.hpp"

namespace luciole {

/// Appends everything the file's default scene shows to `scene`: meshes, materials, textures, objects, lights
/// and cameras. Reads .gltf and .glb. `variant`: one of the file's, by its name (KHR_materials_variants); "":
/// the default materials. Throws InputError; its message names a required extension that is not supported. An
/// object may be mirrored: then the determinant of its transform is negative, and in world space the fronts
/// of its triangles are clockwise.
void loadGltf(const std::string& path, Scene& scene, const std::string& variant = "");

}  // namespace luciole
