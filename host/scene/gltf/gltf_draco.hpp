#pragma once

#include "scene/gltf/gltf_model.hpp"

namespace luciole {

/// Decodes the primitives that KHR_draco_mesh_compression compresses: each gets accessors of its own in the
/// model, whose buffer views lie in GltfModel::decoded, and becomes a list of triangles. Throws InputError
/// for data that is truncated, isn't a mesh, has counts too large for its bytes, or contradicts the
/// accessors. Primitives of the same data and accessors share the decoded data.
void decodeDraco(GltfModel& model);

}  // namespace luciole
