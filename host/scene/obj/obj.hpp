#pragma once

#include <string>
#include <vector>

#include "luciole/scene.hpp"

namespace luciole {

/// Appends the file's materials and textures to `scene`, and for each of its objects a mesh and an object
/// that places it at the origin: one for each name of its o statements, or of its g statements where these
/// make one object only. Returns the index of the first mesh. Throws InputError. Material colours are taken
/// as linear, vertex colours as sRGB. Missing normals are smooth within a smoothing group, of all objects
/// together, and everywhere in a file without any "s". Triangles that face away from the file's normals are
/// reversed. A missing .mtl or material gets a warning and the default material. Materials are double-sided.
/// Lines, points and curves are left out. search: more folders for files (see findFile).
std::uint32_t loadObj(const std::string& path, Scene& scene, const std::vector<std::string>& search = {});

}  // namespace luciole
