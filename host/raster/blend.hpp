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

/// A key of a surface, by which layers behind each other keep different samples: the object's index in the
/// scene, the index of a triangle of its mesh, and the visible side. The two triangles of a quad have the
/// same key, so that samples are kept evenly across its diagonal: seen from one side, neither is behind the
/// other.
std::uint64_t blendSurface(std::uint32_t object, std::uint32_t triangle_or_quad, bool front);

/// The threshold in [0, 1) of a sample: it keeps a blended surface whose opacity is above. The thresholds of
/// a pixel's samples are (k + u) / count, k from 0 to count − 1, in a random order (stratified). So a surface
/// of constant opacity keeps opacity · count samples, rounded up or down. u and the order are hashed from the
/// pixel of the whole picture and the surface, and depend on nothing else.
double blendThreshold(std::uint64_t surface, const glm::ivec2& pixel, const SampleNumber& sample);

/// The blended materials in use whose opacity may be below 1, as indices of Scene::materials. O(triangles) if
/// any material is blended.
std::vector<std::uint32_t> blendedMaterials(const Scene& scene);

}  // namespace luciole
