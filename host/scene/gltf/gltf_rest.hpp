#pragma once

#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "scene/gltf/gltf_model.hpp"
#include "scene/scene.hpp"

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
void appendRest(const GltfModel& model, const tinygltf::Primitive& primitive, const Mesh& part,
                const std::string& place, RestShape& rest);

/// Throws InputError where a vertex has no influence, or one of a joint beyond `joints`.
void checkInfluences(const GltfModel& model, const RestShape& rest, std::size_t joints,
                     const std::string& place);

/// How many morph targets a mesh has. Throws InputError where its primitives differ in that.
std::size_t targetCount(const GltfModel& model, int mesh);

/// The weights of a node's morph targets: the node's, else its mesh's, else 0. Throws InputError where they
/// aren't one finite number a target.
std::vector<double> targetWeights(const GltfModel& model, int node);

}  // namespace luciole
