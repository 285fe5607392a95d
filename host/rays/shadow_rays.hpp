#pragma once

#include <glm/glm.hpp>

#include "gbuffer/gbuffer.hpp"
#include "rays/ray_cast.hpp"
#include "scene/scene.hpp"

namespace luciole {

/// The scene for rays towards lights, from points that are known to a float's rounding of their distance from
/// `eye` (world). A triangle in whose plane such a point lies lets its ray through, and so do the holes of a
/// material's mask, decided at the textures' finest level. It refers to the scene, which must outlive it.
RayScene buildShadowRays(const Scene& scene, const glm::dvec3& eye);

/// Where the shadows of what a pixel shows are tested from (see raster/lift.hpp); world space. `place`: as by
/// GBuffer::index.
glm::dvec3 shadowStart(const GBuffer& gbuffer, std::size_t place);

/// From a point to a light's middle; world space.
ShadowRay shadowRay(const Light& light, const glm::dvec3& point);

}  // namespace luciole
