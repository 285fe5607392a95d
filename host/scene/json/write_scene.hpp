#pragma once

#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace luciole {

/// A Luciole scene with the given point lights, one a line, as expandLightField makes them. Numbers are
/// written so that reading them gives the same lights to the bit.
std::string lightsScene(const std::vector<Light>& lights);

/// The same with one object, a mesh file, as this camera sees it: to within the rounding of its direction.
/// The path is written as it is: relative to where the scene will lie. Throws InputError for a path that
/// isn't UTF-8.
std::string meshWithLights(const std::string& mesh_path, const Camera& camera,
                           const std::vector<Light>& lights);

/// A copy of a Luciole scene's file without comments, in which these lights, as lightsScene writes them,
/// stand for all its lights and light fields. It is seen by its own cameras, or by `camera` where it has
/// none. Paths in it are turned to lie relative to `folder`, where the copy will be. The file is one that
/// loadScene reads.
std::string sceneWithLights(const std::string& scene_path, const std::string& folder, const Camera& camera,
                            const std::vector<Light>& lights);

/// A path, relative to the current folder, as a file in `folder` would name it.
std::string pathFrom(const std::string& folder, const std::string& path);

}  // namespace luciole
