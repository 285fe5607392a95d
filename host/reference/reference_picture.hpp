#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "raster/rasterize.hpp"
#include "reference/reference.hpp"

namespace luciole {

/// Some pixels of a scene's picture, counted from the top left of the view's crop. Returns the linear R G B
/// of each: the mean of `samples` samples, at samplePoint(). The G-buffers are those of the renderer, but
/// with all objects, also those that the fog hides. Lighting is in double, also of the vertices for
/// Shading::kGouraud.
std::vector<glm::dvec3> referencePicture(const Scene& scene, const View& view, Shading shading, int samples,
                                         std::span<const glm::ivec2> pixels,
                                         const ReferenceSettings& settings);

/// The exposure that suits a scene's picture of this size (see suitableExposure), in stops, measured on such
/// pixels as the renderer's measureExposure() looks at.
double referenceExposure(const Scene& scene, const Camera& camera, glm::ivec2 size, Shading shading,
                         const ReferenceSettings& settings);

/// The exposure that suits these pixels of a lit G-buffer. colors: one for each of `pixels`.
double referenceExposure(const GBuffer& gbuffer, std::span<const glm::ivec2> pixels,
                         std::span<const glm::dvec3> colors);

/// The coverage of some pixels of a scene's picture, counted likewise: the share of each one's samples that
/// show a surface.
std::vector<double> referenceCoverage(const Scene& scene, const View& view, int samples,
                                      std::span<const glm::ivec2> pixels);

/// The same of a G-buffer, which has one sample a pixel: 0 or 1.
std::vector<double> referenceCoverage(const GBuffer& gbuffer, std::span<const glm::ivec2> pixels);

}  // namespace luciole
