#pragma once

#include <string>

#include "scene/gltf/gltf_model.hpp"

namespace luciole {

/// Gives each buffer that only holds the place of what EXT_meshopt_compression leaves out a byte of its own,
/// which glTF spares it and tinygltf asks for. `bytes`: a .gltf or .glb file. Leaves files without the
/// extension, and what isn't JSON, as they are.
std::string withPlaceholders(std::string bytes);

/// Decodes the buffer views that EXT_meshopt_compression compresses into GltfModel::decoded. Throws
/// InputError for ones that are cut short, or whose sizes contradict each other or their data; nothing is
/// allocated for sizes that the data can't hold.
void decodeMeshopt(GltfModel& model);

}  // namespace luciole
