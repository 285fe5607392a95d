#pragma once

#include "luciole/scene.hpp"

namespace luciole {

/// Whether a material has a normal map.
bool hasNormalMaps(const Scene& scene);

/// Gives tangents to the vertices that materials with a normal map need them for and that have none, as M.
/// Mikkelsen's MikkTSpace does for triangles, with v growing upwards ("Simulation of Wrinkled Surfaces
/// Revisited", 2008, and his mikktspace.c, 2011, which glTF prescribes). Corners with the same position,
/// normal and texture coordinates are one; triangles around it that share an edge there and wind the same way
/// in the picture share a tangent: the mean of theirs, each flattened into the plane of the normal and
/// weighted by its angle there. Vertices whose triangles don't share one are doubled. Triangles that have no
/// area in the picture take the tangents of others around their corners; where there are none a corner keeps
/// zeros, and its normal is not bent. O(n log n).
void addTangents(Scene& scene);

/// The same for one mesh and the triangles for which `wanted` is true.
void addTangents(const std::vector<bool>& wanted, Mesh& mesh);

}  // namespace luciole
