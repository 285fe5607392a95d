#pragma once

#include <vector>

#include "scene/gltf/gltf_model.hpp"
#include "scene/scene.hpp"

namespace luciole {

/// The triangles of all primitives of a glTF mesh as one mesh; points and lines are left out, and skins and
/// morph targets keep their rest pose. `materials` lists the glTF materials in use, −1 for the default one;
/// new ones are appended. Mesh::triangle_materials are positions in that list plus `first_material`. `index`
/// must be in range. The mesh is empty where there is nothing to draw. Throws InputError.
Mesh readGltfMesh(const GltfModel& model, int index, std::vector<int>& materials,
                  std::uint32_t first_material);

}  // namespace luciole
