#pragma once

#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace luciole {

/// One material of a .mtl file, not yet interpreted.
struct MtlEntry {
  std::string name;
  std::string file;        ///< the .mtl file's path
  std::string statements;  ///< the lines after its newmtl
};

/// The materials of a .mtl file in order. Throws InputError.
std::vector<MtlEntry> readMtl(const std::string& path);

/// Interprets a material and adds its textures to `scene`, not decoded yet. Always double-sided, because OBJ
/// says nothing of culling. `d` and `Tr` are ignored: nothing is blended here, and programs are known to
/// write "d 0" for opaque materials. A picture that is missing is told in
/// Scene::missing_textures. Throws InputError.
Material readMaterial(const MtlEntry& entry, Scene& scene);

/// Once the textures are decoded: map_d, or a diffuse map with some alpha below 1, makes holes where the
/// opacity is below one half.
void cutHoles(Material& material, const Scene& scene);

}  // namespace luciole
