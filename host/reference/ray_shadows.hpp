#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include "scene/ray_cast.hpp"
#include "scene/scene.hpp"

namespace luciole {

/// The scene for rays towards lights, from points that are known to a float's rounding of their distance from
/// `eye` (world). A triangle in whose plane such a point lies lets its ray through, and so do the holes of a
/// material's mask, decided at the textures' finest level. It refers to the scene, which must outlive it.
RayScene buildShadowRays(const Scene& scene, const glm::dvec3& eye);

/// The share of a light that a point of a surface sees, in [0, 1]: 0 or 1 for a light without a size, else
/// from `samples` rays into the cone that it fills, spread evenly by solid angle. `seed` turns their pattern,
/// which is the same for equal seeds. Back faces cast shadows.
double lightVisibility(const RayScene& rays, const Light& light, const glm::dvec3& point, int samples,
                       std::uint32_t seed);

}  // namespace luciole
