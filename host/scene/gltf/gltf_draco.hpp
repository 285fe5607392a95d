#pragma once

#include "scene/gltf/gltf_model.hpp"

namespace luciole {

/// Decodes the primitives that KHR_draco_mesh_compression compresses: each gets accessors of its own in the
/// model, whose buffer views lie in GltfModel::decoded, and becomes a list of triangles. Throws InputError
/// for data that is cut short, isn't a mesh or says that it holds more than so few bytes can, and where
/// accessors say otherwise than it. Primitives of the same data and accessors share what is decoded.
void decodeDraco(GltfModel& model);

}  // namespace luciole
