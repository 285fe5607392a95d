#pragma once

#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "luciole/scene.hpp"
#include "scene/gltf/gltf_model.hpp"

namespace luciole {

/// A skin's joints: nodes, and for each the transform from the mesh at rest to the node's space.
struct GltfSkin {
  std::vector<int> joints;
  std::vector<glm::dmat4> inverse_binds;
};

/// Reads a skin, whose joints must be nodes of the file. `place` names who refers to it. Throws InputError.
GltfSkin readGltfSkin(const GltfModel& model, int skin, const std::string& place);

/// Appends a primitive's vertices to a shape at rest: positions and normals as `part` has them, the morph
/// targets, and the influences of joints. A vertex whose weights are all 0 follows its first joint. Throws
/// InputError.
void appendRest(const GltfModel& model, const GltfPrimitive& primitive, const Mesh& part,
                const std::string& place, RestShape& rest);

/// Throws InputError where a vertex has no influence, or one of a joint beyond `joints`.
void checkInfluences(const GltfModel& model, const RestShape& rest, std::size_t joints,
                     const std::string& place);

/// How many morph targets a mesh has: of its primitives, that with the most. Throws InputError where there is
/// no such mesh.
std::size_t targetCount(const GltfModel& model, int mesh);

/// The weights of a node's morph targets: the node's, else its mesh's, else 0; one a target.
std::vector<double> targetWeights(const GltfModel& model, int node);

/// Warns of meshes whose primitives have different numbers of targets, and of nodes and meshes that don't
/// have one weight a target. Of too many the last ones are left out, and those that are too few are 0.
void checkWeights(const GltfModel& model);

}  // namespace luciole
