#pragma once

#include <string>
#include <vector>

#include "luciole/scene.hpp"

namespace luciole {

/// The text of a Luciole scene with the given lights, one a line. It keeps the members that expandLightField
/// sets, but for the group. Reading it gives the same lights to the bit, but for directions, which keep all
/// but their last bit.
std::string lightsScene(const std::vector<Light>& lights);

/// The same with one object, a mesh file, and a camera, whose direction is kept to within its rounding. The
/// path is written as it is: a relative one starts at the scene's folder. Throws InputError for a path that
/// isn't UTF-8.
std::string meshWithLights(const std::string& mesh_path, const Camera& camera,
                           const std::vector<Light>& lights);

/// A copy of a Luciole scene's file, without comments, in which these lights (as lightsScene writes them)
/// replace all its lights and light fields. It keeps its cameras, or gets `camera` where it has none.
/// Relative paths are rewritten for `folder`, where the copy will lie. The file must be one that loadScene
/// reads.
std::string sceneWithLights(const std::string& scene_path, const std::string& folder, const Camera& camera,
                            const std::vector<Light>& lights);

/// Rewrites a path that is relative to the current folder as one relative to `folder`.
std::string pathFrom(const std::string& folder, const std::string& path);

}  // namespace luciole
