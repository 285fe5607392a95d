#pragma once

#include <array>
#include <glm/glm.hpp>

#include "scene/scene.hpp"

// Where tests for shadows start: not on the facet that a pixel shows but above it, on the smooth surface that
// the vertex normals tell of. A facet at the terminator faces away from a light that its shading normals
// still face, so that it would shadow itself and the rim of the light would be a staircase of facets.
//
// After J. Hanika, "Hacking the Shadow Terminator", Ray Tracing Gems II (2021), ch. 4. A point p = Σ bᵢ vᵢ of
// a facet lies under the tangent planes of its corners, by (vᵢ − p)·nᵢ. His start point lies on them on
// average, by h along the shading normal n = Σ bᵢ nᵢ:
//
//     h = Σ bᵢ max(0, (vᵢ − p)·nᵢ) / |n|        own = max (vᵢ − p)·n / |n|        p' = p + lift · n / |n|
//     lift = own, but at least h / 2 and at most h
//
// Half of it, because of normals that turn evenly the surface runs half way between the facet and his points.
// Corners that lie on the unit sphere at their own normals have n = p and h |n| = 1 − |n|², and so
// (p + h/2 · n/|n|)·n/|n| = (1 + |n|²) / (2 |n|) ≥ 1: the whole sphere lies behind the plane through p' that
// the shading normal stands on, and no facet of it is met on any way to the front of that plane. The same is
// true of ellipsoids, cylinders and cones of them, whatever the transform, as sums and planes go through it
// unharmed. More than half only where that leaves corners of the facet itself, `own`, in front of the plane,
// as on a saddle. Where a surface is hollow p lies above the tangent planes, h is 0, and p stays where it is.
namespace luciole {

/// The lift of a triangle's points. rise[i][0] is (vᵢ − v)·nᵢ with v the next
/// corner, rise[i][1] with the one after that; of a corner that the facet's own
/// normal stands on, 0.
struct Lift {
  bool any = false;  ///< false: all is 0
  double rise[3][2]{};
  double most = 0.0;  ///< metres, half of the longest side: as for a half circle over it
};

/// Its corners' normals, in any length, and sides in the same space; which
/// corners bend: see bentCorners().
Lift makeLift(const glm::bvec3& bent, const std::array<glm::dvec3, 3>& normals, const glm::dvec3& edge1,
              const glm::dvec3& edge2);

/// The corners whose normals lean from their triangle's by more than
/// kFlatAngle, and not to its other side.
glm::bvec3 bentCorners(const Mesh& mesh, const glm::uvec3& corners);

/// Below this, in radians, normals are taken for those of a flat facet that
/// were rounded; facets that lean so little from the surface have no staircase
/// that could be seen.
inline constexpr double kFlatAngle = 0x1p-10;

/// Whether any mesh has a bent corner.
bool hasBentCorners(const Scene& scene);

}  // namespace luciole
