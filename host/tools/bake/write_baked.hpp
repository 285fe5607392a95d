#pragma once

#include <string>
#include <vector>

#include "luciole/scene.hpp"

namespace luciole {

/// Writes a .glb or .gltf of an object with its light map, without lights: the map is the emissive texture of
/// a black material. `png`: the map's bytes, in sRGB codes. `strength`: the radiance of its white
/// (KHR_materials_emissive_strength), ≥ 0. `uvs`: the vertices' texture coordinates in the map. Throws as
/// writeGltf does.
void writeBakedGltf(const Scene& scene, const Object& object, std::vector<glm::vec2> uvs,
                    const std::string& png, float strength, const std::string& path);

}  // namespace luciole
