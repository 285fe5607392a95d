#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>

#include "scene/lights/light_field.hpp"

namespace luciole {

/// Makes the function that gives one light's place after another, world space, metres, drawing random numbers
/// from the state that it is given. It refers to the field and the scene. Not for lists. Throws InputError
/// for FieldShape::kSurface in a scene whose triangles have no area.
std::function<glm::dvec3(std::uint64_t& state)> lightPlaces(const LightField& field, const Scene& scene);

}  // namespace luciole
