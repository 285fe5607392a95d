#pragma once

#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace luciole {

/// Appends the file's mesh, materials and textures to `scene`, and one object that places it at the origin.
/// Returns the index of the mesh. Throws InputError. Colours in the file, vertex colours too, are taken as
/// linear. Missing normals are smooth within a smoothing group, and everywhere in a file without any "s".
/// Triangles that face away from the file's normals are reversed. Where the .mtl or a material is missing,
/// the default material is used. Materials are double-sided. Lines, points and curves are left out.
/// Files that aren't where it says are looked for in the folders `search`, too (see findFile).
std::uint32_t loadObj(const std::string& path, Scene& scene, const std::vector<std::string>& search = {});

}  // namespace luciole
