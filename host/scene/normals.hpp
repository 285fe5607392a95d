#pragma once

#include <glm/glm.hpp>
#include <vector>

namespace luciole {

/// One unit normal a vertex: the mean of the unit normals of the triangles that use it, each weighted by its
/// angle at the vertex, so that the result doesn't depend on how polygons were triangulated (Thürmer &
/// Wüthrich, "Computing Vertex Normals from Polygonal Facets", 1998). Triangles that share no vertex get flat
/// normals. Where the mean vanishes, the normal of one of the triangles is taken, or +z where none has an
/// area. O(vertices + triangles).
std::vector<glm::vec3> angleWeightedNormals(const std::vector<glm::vec3>& positions,
                                            const std::vector<glm::uvec3>& triangles);

}  // namespace luciole
