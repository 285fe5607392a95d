#pragma once

#include <map>

#include "scene/animation.hpp"
#include "scene/gltf/gltf_model.hpp"

namespace luciole {

/// The curves that move a node, members of Animation::curves; -1: none.
struct NodeCurves {
  int translation = -1;
  int rotation = -1;  ///< quaternions x, y, z, w
  int scale = -1;
};

/// Reads the animations of a glTF file into curves over frames (frame 1 is time 0), by the node that they
/// move. All animations run together; where two move the same part of a node, the first does. Morph weights
/// are left out. Throws InputError where the numbers don't fit together.
std::map<int, NodeCurves> readGltfAnimations(const GltfModel& model, Animation& animation);

}  // namespace luciole
