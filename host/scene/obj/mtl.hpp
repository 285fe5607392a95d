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
/// write "d 0" for opaque materials. Missing pictures are noted in Scene::missing_textures. Throws
/// InputError.
Material readMaterial(const MtlEntry& entry, Scene& scene);

/// Sets alpha_cutoff, once the textures are decoded: with a map_d, or a diffuse map with some alpha below 1,
/// there are holes where the opacity is below one half.
void cutHoles(Material& material, const Scene& scene);

}  // namespace luciole
