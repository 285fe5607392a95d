#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "raster/rasterize.hpp"
#include "reference/reference.hpp"

namespace luciole {

/// Some pixels of a scene's picture, linear R G B each; (x, y) counted from the view's crop. The G-buffers
/// are the renderer's own, but with every object in them, whatever the fog hides; all that follows is in
/// double. For Shading::kGouraud the vertices are lit so, too. The mean of `samples` samples a pixel, at
/// samplePoint().
std::vector<glm::dvec3> referencePicture(const Scene& scene, const View& view, Shading shading, int samples,
                                         std::span<const glm::ivec2> pixels,
                                         const ReferenceSettings& settings);

}  // namespace luciole
