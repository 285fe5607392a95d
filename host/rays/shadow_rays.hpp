#pragma once

#include <glm/glm.hpp>

#include "luciole/gbuffer.hpp"
#include "luciole/scene.hpp"
#include "rays/ray_cast.hpp"

namespace luciole {

/// Builds the scene for shadow rays, from points whose coordinates relative to `eye` (world space) were
/// rounded to float. A triangle in whose plane the start of a ray lies, to within that rounding, doesn't
/// block it: so no surface shadows itself. Nor do the holes of a material's mask, looked up at the textures'
/// finest level. The result refers to the scene, which must outlive it. Throws as buildRayScene and
/// placeObjects do.
RayScene buildShadowRays(const Scene& scene, const glm::dvec3& eye);

/// The point from which a pixel's shadows are tested (see raster/lift.hpp), world space. `place`: as by
/// GBuffer::index.
glm::dvec3 shadowStart(const GBuffer& gbuffer, std::size_t place);

/// The ray from a point to a light's centre, world space; infinitely long for a directional light. At the
/// light's own position it has no direction, and hits nothing.
ShadowRay shadowRay(const Light& light, const glm::dvec3& point);

}  // namespace luciole
