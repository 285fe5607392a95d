#pragma once

#include <string>

#include "scene/scene.hpp"

namespace luciole {

/// Appends the file's mesh, materials and textures to `scene`, and one object that places it at the origin.
/// Returns the index of the mesh. Throws InputError.
/// Numbers of the file, vertex colours too, are linear. Missing normals are smooth within a smoothing group,
/// and everywhere in a file without any "s". Triangles are wound to agree with the normals that the file
/// gives. A missing .mtl, or a material that it hasn't got, gives the default material. Lines, points and
/// curves are left out.
std::uint32_t loadObj(const std::string& path, Scene& scene);

}  // namespace luciole
