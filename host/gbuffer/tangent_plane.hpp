#pragma once

#include <glm/glm.hpp>

#include "luciole/gbuffer.hpp"

namespace luciole {

/// The tangent of a surface with this unit normal, in view space, perpendicular to it and of a length that is
/// neither 0 nor infinite. `along`: the direction in which the texture coordinate u grows (dP/du), of any
/// length, or 0 where there is none; the tangent is that direction as far as it lies in the surface. Without
/// it the tangent goes around the world's up axis, as cross(up, normal), and where that vanishes too, around
/// its x axis. A part of 2⁻¹⁰ of a vector, or less, counts as none: there the rounding of normals to float,
/// 2⁻²⁴, would turn the tangent by more than the rounding of packed directions. world_to_view: a rotation.
inline glm::dvec3 tangentOf(const glm::dvec3& along, const glm::dvec3& normal,
                            const glm::dmat3& world_to_view) {
  const auto is_some = [](const glm::dvec3& part, const glm::dvec3& of) {
    return glm::dot(part, part) > 0x1p-20 * glm::dot(of, of);
  };
  const glm::dvec3 flat = along - normal * glm::dot(normal, along);
  if (is_some(flat, along)) return flat;
  const glm::dvec3 around_up = glm::cross(world_to_view[1], normal);
  return is_some(around_up, normal) ? around_up : glm::cross(world_to_view[0], normal);
}

/// The normals of a G-buffer, packed; 0 where it has none.
PackedNormals packedNormals(const GBuffer& gbuffer);

/// GBuffer::tangent of normals alone: what a G-buffer's surfaces have without texture coordinates.
PackedNormals tangentsOf(const GBuffer& gbuffer);

}  // namespace luciole
