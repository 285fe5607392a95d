#pragma once

#include "scene/gltf/gltf_model.hpp"

namespace luciole {

/// Decodes the primitives that KHR_draco_mesh_compression compresses: each gets accessors of its own in the
/// model, whose buffer views lie in GltfModel::decoded, and becomes a list of triangles. Throws InputError
/// for data that is cut short or isn't a mesh, and where accessors say otherwise than it.
void decodeDraco(GltfModel& model);

}  // namespace luciole
