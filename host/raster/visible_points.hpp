#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "luciole/gbuffer.hpp"
#include "luciole/scene.hpp"
#include "scene/bounds.hpp"

namespace luciole {

/// Points of the scene's surfaces, in world space and metres, that `count` pixels of a picture show; all of
/// them if fewer show something. Pixels are chosen at random, all equally likely; the same seed gives the
/// same points. Draws the whole picture. Throws as rasterize does.
std::vector<glm::dvec3> visiblePoints(const Scene& scene, const Camera& camera, glm::ivec2 size,
                                      std::size_t count, std::uint64_t seed);

/// The same of the pixels of a G-buffer.
std::vector<glm::dvec3> visiblePoints(const GBuffer& gbuffer, std::size_t count, std::uint64_t seed);

/// A box for lights, around visible points, world space, metres: from the 5th to the 95th percentile along
/// each axis, so that a little sky or far horizon doesn't enlarge it. A side shorter than a tenth of the
/// longest, such as the height of a floor, is extended to a tenth towards the eye, where lights shine on the
/// visible side. `points` must not be empty. O(n log n).
Bounds seenBox(std::span<const glm::dvec3> points, const glm::dvec3& eye);

}  // namespace luciole
