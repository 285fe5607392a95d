#pragma once

#include <map>
#include <vector>

#include "luciole/animation.hpp"
#include "scene/gltf/gltf_model.hpp"

namespace luciole {

/// The curves that move a node: indices into Animation::curves; -1: none.
struct NodeCurves {
  int translation = -1;
  int rotation = -1;  ///< quaternions x, y, z, w
  int scale = -1;
  std::vector<int> weights;  ///< of the morph targets of its mesh, four a curve; empty: none
};

/// Whether curves move the node itself.
inline bool movesNode(const NodeCurves& curves) {
  return curves.translation >= 0 || curves.rotation >= 0 || curves.scale >= 0;
}

/// Reads the animations of a glTF file into curves over frames (frame 1 is time 0, at animation.frame_rate).
/// Returns the curves of each animated node by its index. If several animations move the same property of a
/// node, the first one counts. Throws InputError for invalid animations.
std::map<int, NodeCurves> readGltfAnimations(const GltfModel& model, Animation& animation);

}  // namespace luciole
