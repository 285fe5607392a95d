#pragma once

#include "scene/gltf/gltf_model.hpp"

namespace luciole {

/// Decodes the buffer views that EXT_meshopt_compression compresses into GltfModel::decoded. Throws
/// InputError for ones that are cut short, or whose sizes contradict each other or their data; nothing is
/// allocated for sizes that the data can't hold.
void decodeMeshopt(GltfModel& model);

}  // namespace luciole
