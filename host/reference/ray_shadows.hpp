#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include "luciole/scene.hpp"
#include "rays/shadow_rays.hpp"

namespace luciole {

/// The share of a light that a point of a surface sees, in [0, 1]. A light without a size takes one ray and
/// gives 0 or 1. A light with a size takes `samples` rays into the cone of directions in which it is seen,
/// spread evenly by solid angle; equal seeds give equal patterns, and another seed turns the pattern. Inside
/// a light all of it is visible. point: world space, metres. Back faces cast shadows.
double lightVisibility(const RayScene& rays, const Light& light, const glm::dvec3& point, int samples,
                       std::uint32_t seed);

}  // namespace luciole
