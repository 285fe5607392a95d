#pragma once

#include <vector>

#include "luciole/scene.hpp"
#include "scene/gltf/gltf_model.hpp"

namespace luciole {

/// The triangles of all primitives of a glTF mesh as one mesh, at rest; points and lines are left out, with a
/// warning. `materials` lists the glTF materials in use, −1 for the default one; new ones are appended.
/// Mesh::triangle_materials are positions in that list plus `first_material`. `index` must be in range. The
/// mesh is empty if it has no triangles. `rest`: null, or receives the shape at rest with morph targets and
/// influences of joints; then the mesh has `sources`. Throws InputError.
Mesh readGltfMesh(const GltfModel& model, int index, std::vector<int>& materials,
                  std::uint32_t first_material, RestShape* rest = nullptr);

}  // namespace luciole
