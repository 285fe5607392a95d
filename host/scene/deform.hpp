#pragma once

#include <glm/glm.hpp>
#include <span>
#include <string>
#include <vector>

#include "luciole/deformation.hpp"
#include "luciole/scene.hpp"

namespace luciole {

/// The numbers of a pose, as in Deformation::pose. Meshes of equal numbers have equal shapes. nodes: the
/// transforms of Animation::nodes. weights: of the targets.
std::vector<double> poseNumbers(const Deformation& deformation, std::span<const glm::dmat4> nodes,
                                std::span<const double> weights);

/// A joint's matrix in a pose.
glm::dmat4 jointMatrix(std::span<const double> pose, std::size_t joint);

/// The weighted mean of the matrices of the joints that influence a vertex, of which there must be one.
glm::dmat4 meanOfJoints(const RestShape& rest, std::uint32_t vertex, std::span<const double> pose);

/// Writes the positions, normals and tangents of a pose into the mesh, computed in double from the rest:
/// linear blend skinning. With M the weighted mean of the joints' matrices, a position becomes M · position,
/// a tangent M · tangent, and a normal cofactors(M) · normal with the sign of M's determinant. O(vertices ·
/// influences), on all cores. Returns what is wrong with the result (a position isn't finite), or
/// "".
std::string deform(const Deformation& deformation, std::span<const double> pose, Mesh& mesh);

}  // namespace luciole
