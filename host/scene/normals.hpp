#pragma once

#include <glm/glm.hpp>
#include <vector>

namespace luciole {

/// One unit normal a vertex: the mean of the unit normals of the triangles that use it, each weighted by its
/// angle there, so that how a polygon was cut into triangles does not matter (Thürmer & Wüthrich, "Computing
/// Vertex Normals from Polygonal Facets", 1998). Triangles that share no vertex get flat normals. Where the
/// mean vanishes it is the normal of one of the triangles, and +z where none has an area.
std::vector<glm::vec3> angleWeightedNormals(const std::vector<glm::vec3>& positions,
                                            const std::vector<glm::uvec3>& triangles);

}  // namespace luciole
