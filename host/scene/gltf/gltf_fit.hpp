#pragma once

#include <string>

namespace luciole {

/// Fits a .gltf or .glb file for tinygltf, which refuses some of what glTF allows. A buffer that only holds
/// the place of what EXT_meshopt_compression leaves out gets a byte of its own, an accessor
/// of what Draco compresses its buffer view, a skin without inverseBindMatrices the index -1, and a channel
/// without a node, of which an extension says what it moves, is taken out. Leaves other files, and what isn't
/// JSON, as they are. O(bytes).
std::string fitForTinygltf(std::string bytes);

}  // namespace luciole
