#pragma once

#include "scene/gltf/gltf_model.hpp"

namespace luciole {

/// Decodes the buffer views compressed by EXT_meshopt_compression into GltfModel::decoded. Throws InputError
/// for truncated ones, and for sizes that contradict each other or their data. Checks sizes before it
/// allocates.
void decodeMeshopt(GltfModel& model);

}  // namespace luciole
