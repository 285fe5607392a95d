#pragma once

#include <cstdint>
#include <span>

#include "kernels/shared.h"
#include "luciole/scene.hpp"

namespace luciole {

/// Gives the lights of a set that have a profile their luminaires' numbers, from 1 on, in
/// ShadeLight::ambient. Returns the luminaires, in the camera's view space, and their profiles, each once:
/// what kernels/shade/profile.clh reads. order: of each of `lights` its index in the scene. Throws InputError
/// where these are too many for a float to count. O(lights + entries of the profiles).
RawArray<float> setLuminaires(const Scene& scene, const Camera& camera, std::span<const std::uint32_t> order,
                              std::span<ShadeLight> lights);

/// The axes of a luminaire that shines along a unit direction, world: azimuth 0, azimuth 90 degrees, and the
/// pole.
glm::dmat3 luminaireAxes(const Luminaire& luminaire, const glm::dvec3& direction);

}  // namespace luciole
