#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include "rays/shadow_rays.hpp"
#include "scene/scene.hpp"

namespace luciole {

/// The share of a light that a point of a surface sees, in [0, 1]: 0 or 1 for a light without a size, else
/// from `samples` rays into the cone that it fills, spread evenly by solid angle. `seed` turns their pattern,
/// which is the same for equal seeds. Back faces cast shadows.
double lightVisibility(const RayScene& rays, const Light& light, const glm::dvec3& point, int samples,
                       std::uint32_t seed);

}  // namespace luciole
