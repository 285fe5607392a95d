#pragma once

#include <optional>

#include "raster/square.hpp"
#include "raster/surface.hpp"

namespace luciole {

/// The opacity of a surface at a point: the product of its material's alpha, the vertex colour's, and that of
/// its maps, looked up at `place`. Uses only the surface's object, material and corners.
float opacityAt(const Scene& scene, const Surface& surface, const Weights& weights,
                const TexturePlace& place);

/// Whether a triangle of an object (counted in its mesh) has a hole at a place given by barycentric weights:
/// its opacity there, with maps looked up at their finest level, is below its material's alpha_cutoff. For
/// shadows.
bool isHoleAt(const Scene& scene, const PlacedObject& object, std::uint32_t triangle, const Weights& weights);

/// The texels of a sample, 8 x 8, up to which holes are told by alpha_cutoff alone: mips keep the shape of
/// leaves and grilles that are as wide.
constexpr float kTestedTexels = 64;

/// Whether surfaces of a material may have holes, for a camera.
inline bool hasHoles(const Material& material) { return material.alpha_cutoff > 0.0f || material.blended; }

/// Whether the surface has a hole at a place, as in ViewPlane::at, for a sample of a pixel: its opacity is
/// below its material's alpha_cutoff, or if that is blended not above the sample's blendThreshold().
///
/// Each of several samples a pixel has its share of the pixel's footprint, so that mips don't hide what
/// samples can tell. Where that is n > kTestedTexels texels, the cutoff moves by 1 − kTestedTexels / n of the
/// way to the sample's blendThreshold(), times the material's alpha: mips hold the mean of opacities there,
/// which is about the share of texels that are kept. So holes keep their share of a surface with distance,
/// and leaves don't vanish. Nearer the test alone is sharper, and has no grain.
bool isHole(const Scene& scene, const Surface& surface, const ViewPlane& plane, const glm::dvec2& place,
            const glm::ivec2& pixel, const SampleNumber& sample);

/// The same, bit for bit, for several pixels at once: 1 for `wanted` pixels with a hole, 0 for others.
/// Without a sample blended materials are tested against their alpha_cutoff, too.
LaneMask holesIn(const Scene& scene, const Surface& surface, const ViewPlane& plane, const Lanes<double>& x,
                 const Lanes<double>& y, const LaneMask& wanted, const std::optional<SampleNumber>& sample);

}  // namespace luciole
