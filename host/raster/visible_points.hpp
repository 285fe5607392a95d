#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "scene/bounds.hpp"
#include "scene/scene.hpp"

namespace luciole {

/// Where on the scene's surfaces `count` pixels lie, or all if fewer show something: world space, metres.
/// They are drawn at random from the picture's, each pixel as likely as another, the same for the same seed.
std::vector<glm::dvec3> visiblePoints(const Scene& scene, const Camera& camera, glm::ivec2 size,
                                      std::size_t count, std::uint64_t seed);

/// The part of a scene that is worth lighting: the box from the 5th to the 95th percentile of visible points
/// along each axis, so that a bit of sky or of far horizon doesn't count, which would make the box of the
/// whole scene useless. A side shorter than a tenth of the longest, as that of a floor seen alone, grows to
/// that on the side where the eye is: there light reaches what is seen. `points` not empty.
Bounds seenBox(std::span<const glm::dvec3> points, const glm::dvec3& eye);

}  // namespace luciole
