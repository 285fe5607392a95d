#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "luciole/scene.hpp"
#include "luciole/settings.hpp"

namespace luciole {

/// Some pixels of a scene's picture in double precision, with rays for shadows: linear R G B of each, counted
/// from the top left of the crop. Written from the specification and the papers, and independently of the
/// kernels, to judge a picture by. Uses of the settings `size`, `camera`, `crop`, `samples`, `shading`,
/// `shade.model` and whether there are shadows; exposure is not applied. Takes about a millisecond for a
/// pixel, a sample and a thousand lights. settings.on_pass is called from time to time, in any thread, with
/// the pixels that are done, of how many in all samples; what it throws ends it. Throws InputError as
/// render() does, or for a pixel outside.
std::vector<glm::dvec3> referencePicture(const Scene& scene, const RenderSettings& settings,
                                         std::span<const glm::ivec2> pixels);

}  // namespace luciole
