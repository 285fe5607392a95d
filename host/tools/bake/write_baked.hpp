#pragma once

#include <string>
#include <vector>

#include "luciole/scene.hpp"

namespace luciole {

/// Writes a .glb or .gltf that shows a map's light on an object, without any light: the map is the emissive
/// texture of a black material. `png`: its bytes, in sRGB codes; `strength`: what the light of its white is
/// (KHR_materials_emissive_strength), ≥ 0; `uvs`: where each vertex is in it. Throws as writeGltf does.
void writeBakedGltf(const Scene& scene, const Object& object, std::vector<glm::vec2> uvs,
                    const std::string& png, float strength, const std::string& path);

}  // namespace luciole
