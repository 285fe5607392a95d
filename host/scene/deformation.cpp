#include "scene/deform.hpp"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "scene/normals.hpp"

namespace luciole {
namespace {

constexpr std::size_t kMatrix = 16;  ///< numbers a joint has in a pose

/// The offsets of all targets for each vertex of the rest; empty if no target has a weight.
struct Morph {
  std::vector<glm::dvec3> positions, normals, tangents;
};

Morph morphOf(const RestShape& rest, std::span<const double> weights) {
  Morph morph;
  for (std::size_t t = 0; t < weights.size(); ++t) {
    if (weights[t] == 0) continue;
    const MorphTarget& target = rest.targets[t];
    for (std::vector<glm::dvec3>* sums : {&morph.positions, &morph.normals, &morph.tangents})
      sums->resize(rest.positions.size(), glm::dvec3(0));
    for (std::size_t i = 0; i < target.vertices.size(); ++i) {
      const std::uint32_t vertex = target.vertices[i];
      morph.positions[vertex] += weights[t] * glm::dvec3(target.positions[i]);
      morph.normals[vertex] += weights[t] * glm::dvec3(target.normals[i]);
      morph.tangents[vertex] += weights[t] * glm::dvec3(target.tangents[i]);
    }
  }
  return morph;
}

/// A vector's direction; 0 where it has none.
glm::dvec3 directionOf(const glm::dvec3& vector) {
  const double length = glm::length(vector);
  return length > 0 && std::isfinite(length) ? vector / length : glm::dvec3(0);
}

bool isFinite(const glm::vec3& point) {
  return std::isfinite(point.x) && std::isfinite(point.y) && std::isfinite(point.z);
}

/// Sets normals that are 0 to those of the triangles around the vertex.
void fillNormals(Mesh& mesh) {
  std::vector<glm::vec3> from_faces;
  for (std::size_t i = 0; i < mesh.normals.size(); ++i) {
    if (mesh.normals[i] != glm::vec3(0)) continue;
    if (from_faces.empty()) from_faces = angleWeightedNormals(mesh.positions, mesh.triangles);
    mesh.normals[i] = from_faces[i];
  }
}

}  // namespace

std::vector<double> poseNumbers(const Deformation& deformation, std::span<const glm::dmat4> nodes,
                                std::span<const double> weights) {
  std::vector<double> pose;
  pose.reserve(kMatrix * deformation.joints.size() + weights.size());
  for (const Joint& joint : deformation.joints) {
    const glm::dmat4 to_world =
        joint.node < 0 ? joint.after : nodes[static_cast<std::size_t>(joint.node)] * joint.after;
    const glm::dmat4 matrix = deformation.world_to_mesh * to_world;
    for (int column = 0; column < 4; ++column)
      for (int row = 0; row < 4; ++row) pose.push_back(matrix[column][row]);
  }
  pose.insert(pose.end(), weights.begin(), weights.end());
  return pose;
}

glm::dmat4 jointMatrix(std::span<const double> pose, std::size_t joint) {
  glm::dmat4 matrix;
  for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = pose[kMatrix * joint + std::size_t(i)];
  return matrix;
}

glm::dmat4 meanOfJoints(const RestShape& rest, std::uint32_t vertex, std::span<const double> pose) {
  glm::dmat4 sum(0.0);
  double weights = 0;
  for (std::uint32_t i = rest.first_influence[vertex]; i < rest.first_influence[vertex + 1]; ++i) {
    const double weight = rest.influence_weights[i];
    const double* const matrix = &pose[rest.influence_joints[i] * kMatrix];
    for (int column = 0; column < 4; ++column)
      for (int row = 0; row < 3; ++row) sum[column][row] += weight * matrix[4 * column + row];
    weights += weight;
  }
  sum /= weights;
  sum[3][3] = 1;
  return sum;
}

std::string deform(const Deformation& deformation, std::span<const double> pose, Mesh& mesh) {
  const RestShape& rest = *deformation.rest;
  const bool has_skin = !deformation.joints.empty();
  const Morph morph = morphOf(rest, pose.subspan(kMatrix * deformation.joints.size()));
  const bool morphs = !morph.positions.empty();
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, mesh.positions.size(), 1024), [&](const auto& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      const std::uint32_t source = mesh.sources[i];
      glm::dvec3 position(rest.positions[source]), normal(rest.normals[source]);
      glm::dvec4 tangent(mesh.tangents.empty() ? glm::vec4(0) : deformation.tangents[i]);
      const bool is_flat = normal == glm::dvec3(0), is_bare = tangent == glm::dvec4(0);
      if (morphs) {
        position += morph.positions[source];
        normal += morph.normals[source];
        tangent += glm::dvec4(morph.tangents[source], 0);
      }
      if (has_skin) {
        const glm::dmat4 joints = meanOfJoints(rest, source, pose);
        const glm::dmat3 m(joints);
        const double side = glm::determinant(m) < 0 ? -1 : 1;
        position = glm::dvec3(joints * glm::dvec4(position, 1));
        normal = side * (glm::dmat3(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1])) *
                         normal);
        tangent = {m * glm::dvec3(tangent), side * tangent.w};
      }
      mesh.positions[i] = position;
      mesh.normals[i] = is_flat ? glm::dvec3(0) : directionOf(normal);
      if (mesh.tangents.empty()) continue;
      const glm::dvec3 direction = is_bare ? glm::dvec3(0) : directionOf(glm::dvec3(tangent));
      mesh.tangents[i] = glm::dvec4(direction, direction == glm::dvec3(0) ? 0.0 : tangent.w);
    }
  });
  if (!std::ranges::all_of(mesh.positions, isFinite)) return "a vertex's position is not finite";
  fillNormals(mesh);
  return "";
}

}  // namespace luciole
