#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>

#include "scene/lights/light_field.hpp"

namespace luciole {

/// Makes the function that draws the lights' positions, one a call: world space, metres. It takes random
/// numbers from the state that it is given. It refers to the field and the scene, which must outlive it. Not
/// for FieldShape::kList. Throws InputError for FieldShape::kSurface in a scene whose triangles have no area.
std::function<glm::dvec3(std::uint64_t& state)> lightPlaces(const LightField& field, const Scene& scene);

}  // namespace luciole
