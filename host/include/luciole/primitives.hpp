#pragma once

#include <compare>
#include <cstdint>

#include "luciole/scene.hpp"

namespace luciole {

enum class PrimitiveKind : std::uint8_t { kPlane, kBox, kSphere, kCylinder, kCone, kTorus };

/// A shape that is generated, around the origin, y up, in metres:
///   plane     1 × 1 in xz, facing +y; the only one that is open
///   box       side 1
///   sphere    radius 1
///   cylinder  radius 1, from y = 0 to 1, capped
///   cone      radius 1 at y = 0, apex at y = 1, capped
///   torus     around the y axis: circles of `minor_radius` around a circle of radius 1
/// A texture's top lies towards +y; on faces that point up towards −z, on those that point down towards +z.
/// Seen from outside, textures aren't mirrored.
struct Primitive {
  PrimitiveKind kind = PrimitiveKind::kPlane;
  /// Plane, and each side of a box: squares a side, 1 or more. Round shapes: sides around, 3 or more (sphere
  /// and torus have half as many the other way). At most kMostSegments.
  int segments = 1;
  float minor_radius = 0.25f;  ///< torus only; 0 < minor_radius < 1
  float uv_scale = 1.0f;       ///< how often a texture repeats along u and v
  int lit_segments = 0;        ///< `segments` of Mesh::divided; 0: there is none
  auto operator<=>(const Primitive&) const = default;
};
inline constexpr int kMostSegments = 4096;

/// The shape's mesh. Every triangle has `material`. With `lit_segments` > 0 it has a divided form. Normals
/// are smooth where the surface is and split at sharp edges; vertices that are split there or at the
/// texture's seam lie at exactly the same place.
Mesh makePrimitive(const Primitive& primitive, std::uint32_t material);

}  // namespace luciole
