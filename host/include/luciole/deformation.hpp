#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace luciole {

struct Mesh;

/// How far a morph target with a weight of 1 moves vertices. Those that it leaves alone are left out.
struct MorphTarget {
  std::vector<std::uint32_t> vertices = {};  ///< of the RestShape, ascending
  /// One for each of `vertices`, of the RestShape's length and of tangents' directions.
  std::vector<glm::vec3> positions = {}, normals = {}, tangents = {};
};

/// What deforms, as it is at rest. Mesh::sources says which vertex of it a mesh's vertex is.
struct RestShape {
  std::vector<glm::vec3> positions = {};
  std::vector<glm::vec3> normals =
      {};  ///< unit; 0: the vertex shows flat triangles, whose normals are theirs
  std::vector<MorphTarget> targets = {};
  std::vector<std::uint32_t> first_influence{0};     ///< of each vertex, and then the count of all
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
  std::vector<double> weights = {};      ///< of the targets, where no curve moves them
  /// In Animation::curves: of the targets' weights, four a curve. Empty: they are `weights`.
  std::vector<int> weight_curves = {};
  std::vector<Joint> joints = {};  ///< none: there is no skin
  glm::dmat4 world_to_mesh{1.0};   ///< from the space that joints move positions to
  std::vector<double> pose = {};   ///< what the mesh shows, see poseNumbers(); empty: the rest
};

/// The numbers of a pose: for each joint its matrix from rest to the mesh's space, by columns, then a weight
/// for each target. Meshes of equal numbers have equal shapes. nodes: the transforms of Animation::nodes.
/// weights: of the targets.
std::vector<double> poseNumbers(const Deformation& deformation, std::span<const glm::dmat4> nodes,
                                std::span<const double> weights);

/// A joint's matrix in a pose.
glm::dmat4 jointMatrix(std::span<const double> pose, std::size_t joint);

/// The weighted mean of the matrices of the joints that influence a vertex, of which there must be one.
glm::dmat4 meanOfJoints(const RestShape& rest, std::uint32_t vertex, std::span<const double> pose);

/// Writes the positions, normals and tangents of a pose into the mesh, computed in double from the rest. A
/// position is what the weighted mean of the joints' matrices makes of it, a normal what that mean's
/// cofactors do, with the sign of its determinant, a tangent what the mean itself does. O(vertices ·
/// influences), on all cores. Returns what is wrong with the result (a position isn't finite), or "".
std::string deform(const Deformation& deformation, std::span<const double> pose, Mesh& mesh);

}  // namespace luciole
