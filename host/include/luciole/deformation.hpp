#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <vector>

namespace luciole {

/// The offsets by which a morph target with a weight of 1 moves vertices. It has no entry for other vertices.
struct MorphTarget {
  std::vector<std::uint32_t> vertices = {};  ///< of the RestShape, ascending
  /// One for each of `vertices`, of the RestShape's length and of tangents' directions.
  std::vector<glm::vec3> positions = {}, normals = {}, tangents = {};
};

/// The shape of a mesh at rest. Mesh::sources maps the mesh's vertices to the vertices here.
struct RestShape {
  std::vector<glm::vec3> positions = {};
  std::vector<glm::vec3> normals =
      {};  ///< unit; 0: flat shading, the vertex takes the normals of its triangles
  std::vector<MorphTarget> targets = {};
  /// For each vertex the index of its first influence, then the number of all influences.
  std::vector<std::uint32_t> first_influence{0};
  std::vector<std::uint32_t> influence_joints = {};  ///< index into Deformation::joints
  std::vector<float> influence_weights = {};         ///< above 0; their sum over a vertex may be any
};

/// A joint moves rest positions to world space by its node's transform · after.
struct Joint {
  int node = -1;  ///< in Animation::nodes; -1: the world
  glm::dmat4 after{1.0};
};

/// How a mesh's shape changes: morph targets move its vertices, then joints do (glTF 2.0, 3.7.2.2 and
/// 3.7.3.3).
struct Deformation {
  std::uint32_t mesh = 0;  ///< in Scene::meshes; no other deforms it
  std::shared_ptr<const RestShape> rest = {};
  std::vector<glm::vec4> tangents = {};  ///< Mesh::tangents at rest
  std::vector<double> weights = {};      ///< of the targets, unless curves move them
  /// In Animation::curves: four targets' weights a curve. Empty: the weights are `weights`.
  std::vector<int> weight_curves = {};
  std::vector<Joint> joints = {};  ///< empty: no skin
  glm::dmat4 world_to_mesh{1.0};   ///< from the space that joints move positions to
  /// The pose that the mesh shows, set by poseScene(): for each joint its matrix from rest to the mesh's
  /// space, column by column, then a weight for each target. Empty: the shape at rest.
  std::vector<double> pose = {};
};

}  // namespace luciole
