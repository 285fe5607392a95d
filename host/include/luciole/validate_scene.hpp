#pragma once

#include <string>

#include "luciole/scene.hpp"

namespace luciole {

/// Throws InputError where a scene isn't what the structs in luciole/scene.hpp and luciole/animation.hpp say:
/// an index that points nowhere, arrays whose sizes don't fit, a number that isn't finite or is out of its
/// range, an enumerator that there isn't. Of lights and fog only what shading gives no meaning is refused.
/// The message is one line that names the place, after the scene's name if it has one:
/// "meshes[3].triangles[17]: refers to vertex 99, but the mesh has 12". What passes stays valid at every pose
/// (poseScene()). O(vertices + triangles + lights), on all cores, at the speed of memory.
void validateScene(const Scene& scene);

/// The fault of a camera, as "fov_y: 4 radians, expected …", or "".
std::string cameraFault(const Camera& camera);

}  // namespace luciole
