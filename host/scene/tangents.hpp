#pragma once

#include "luciole/scene.hpp"

namespace luciole {

/// Whether a material has a normal map.
bool hasNormalMaps(const Scene& scene);

/// Computes missing tangents at vertices of materials with a normal map, as M. Mikkelsen's MikkTSpace does
/// for triangles, with v growing upwards ("Simulation of Wrinkled Surfaces Revisited", 2008, and his
/// mikktspace.c, 2011, which glTF prescribes). Corners with the same position, normal and texture coordinates
/// are welded. Around a welded corner, triangles that share an edge and have the same winding in texture
/// space share a tangent: the mean of theirs, each projected into the plane of the normal and weighted by its
/// angle there. Vertices with several tangents are duplicated. Triangles without area in texture space take
/// the tangents of others around their corners; without any the tangent is zero, and the normal isn't bent.
/// O(n log n).
void addTangents(Scene& scene);

/// The same for all materials, after those with a normal map, and for the meshes' divided forms: for shaders.
/// What they get differs where texture coordinates jump along an edge but go on alike beyond it, as around a
/// sphere: there the triangles of both sides share a tangent, so that highlights along it show no seam.
void addAllTangents(Scene& scene);

/// The same for one mesh and the triangles for which `wanted` is true.
void addTangents(const std::vector<bool>& wanted, Mesh& mesh, bool across_seams = false);

}  // namespace luciole
