#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "luciole/scene.hpp"
#include "raster/view.hpp"

// Blended surfaces are dithered: each sample of a pixel shows one or doesn't, so that the share of samples
// that do is its opacity (Enderton, Sintorn, Shirley and Luebke, "Stochastic transparency", 2010). Nothing is
// sorted, and the mean over samples is right for any number of layers.
namespace luciole {

/// What tells surfaces apart, so that layers behind each other keep different samples: an object, by its
/// number in the scene, a triangle of its mesh or a quad's two, and the side that is seen. Two triangles of
/// one side that share an edge are never behind each other, so a quad may count as one surface, whose samples
/// are then kept evenly across its diagonal.
std::uint64_t blendSurface(std::uint32_t object, std::uint32_t triangle_or_quad, bool front);

/// A sample of a pixel keeps a blended surface where its opacity is above this, which is in [0, 1). Over the
/// samples of a pixel these are (k + u) / count for k from 0 to count − 1 in an order of their own, with one
/// u: of a surface of the same opacity all over as many are kept as the opacity says, rounded up or down. u
/// and the order are hashed from the pixel of the whole picture and the surface, so nothing else changes
/// them.
double blendThreshold(std::uint64_t surface, const glm::ivec2& pixel, const SampleNumber& sample);

/// The blended materials that objects have where anything could show through, as indices of Scene::materials.
/// O(triangles) where any material is blended.
std::vector<std::uint32_t> blendedMaterials(const Scene& scene);

}  // namespace luciole
