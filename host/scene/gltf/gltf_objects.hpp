#pragma once

#include <map>
#include <vector>

#include "luciole/scene.hpp"
#include "scene/gltf/gltf_nodes.hpp"

namespace luciole {

/// Adds the mesh of each node that is shown as an object, its materials and its textures. A mesh of several
/// nodes becomes one mesh and several objects, but for nodes that deform it. What deforms and moves is added
/// to the animation; what doesn't move is deformed now. Throws InputError.
void addGltfObjects(const GltfModel& model, const std::vector<PlacedNode>& nodes,
                    const std::map<int, NodeCurves>& curves, Scene& scene);

}  // namespace luciole
