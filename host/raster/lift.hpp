#pragma once

#include <array>
#include <glm/glm.hpp>

#include "luciole/scene.hpp"

// Where shadow tests start: not on the facet that a pixel shows but above it, near the smooth surface that
// the vertex normals describe. At the terminator a facet faces away from a light that its shading normals
// still face. Tested from the facet it would shadow itself, and the terminator would follow the edges of
// facets.
//
// After J. Hanika, "Hacking the Shadow Terminator", Ray Tracing Gems II (2021), ch. 4. A point p = Σ bᵢ vᵢ of
// a facet lies under the tangent planes of its corners, by (vᵢ − p)·nᵢ. Hanika's start point lies on these
// planes on average, h above p along the shading normal n = Σ bᵢ nᵢ:
//
//     h = Σ bᵢ max(0, (vᵢ − p)·nᵢ) / |n|        own = max (vᵢ − p)·n / |n|        p' = p + lift · n / |n|
//     lift = own, but at least h / 2 and at most h
//
// Half of h, because a surface whose normals turn evenly runs half way between the facet and Hanika's points.
// Take a unit sphere with its corners at their own normals: n = p and h |n| = 1 − |n|², and so (p + h/2 ·
// n/|n|)·n/|n| = (1 + |n|²) / (2 |n|) ≥ 1: the whole sphere lies behind the plane through p' perpendicular to
// the shading normal, and a ray from p' to the front of that plane meets none of its facets. The same holds
// for ellipsoids, cylinders and cones under any affine transform, which keeps sums and planes. The lift is
// more than h / 2 only where corners of the facet itself would otherwise lie in front of that plane (`own`),
// as on a saddle. On a concave surface p lies above the tangent planes: h is 0, and p stays where it is.
namespace luciole {

/// The coefficients of the lift over a triangle. rise[i][0] is (vᵢ − v)·nᵢ with v the next corner, rise[i][1]
/// with v the one after that; 0 for a corner that isn't bent.
struct Lift {
  bool any = false;  ///< false: the lift is 0 everywhere
  double rise[3][2]{};
  double most = 0.0;  ///< metres, an upper limit: half the longest side, as for a half circle over it
};

/// Makes the lift of a triangle. `bent`: see bentCorners(). `normals`: the corners', of any length. `edge1`
/// and `edge2`: the sides from the first corner to the second and third, in the same space.
Lift makeLift(const glm::bvec3& bent, const std::array<glm::dvec3, 3>& normals, const glm::dvec3& edge1,
              const glm::dvec3& edge2);

/// The corners whose normals deviate from their triangle's by more than kFlatAngle, but by less than 90°.
glm::bvec3 bentCorners(const Mesh& mesh, const glm::uvec3& corners);

/// Radians. Normals that deviate less count as those of a flat facet with rounding errors; facets so close to
/// the smooth surface show no visible edge at the terminator.
inline constexpr double kFlatAngle = 0x1p-10;

/// Whether any mesh has a bent corner. O(triangles), in parallel.
bool hasBentCorners(const Scene& scene);

}  // namespace luciole
