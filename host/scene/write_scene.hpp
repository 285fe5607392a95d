#pragma once

#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace luciole {

/// A Luciole scene with the given point lights, one a line, as expandLightField makes them, and, unless the
/// path is empty, one object for a mesh file. Numbers are written so that reading them gives the same lights
/// to the bit. The path is written as it is: relative to where the scene will lie. Throws InputError for a
/// path that isn't UTF-8.
std::string lightsScene(const std::string& mesh_path, const std::vector<Light>& lights);

}  // namespace luciole
