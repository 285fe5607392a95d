#pragma once

#include <cstddef>

#include "kernels/shared.h"
#include "render/render.hpp"
#include "scene/scene.hpp"

// What pictures and lights take, counted from what they are made of.
namespace luciole {

/// A picture is rendered in bands of whole rows, whose pixels take so many bytes in all at most: enough that
/// what is done again for each band, the transformation of all vertices above all, hardly counts, and no
/// more: fresh memory is slow.
inline constexpr std::size_t kBandBytes = std::size_t(512) << 20;

/// A pixel of a G-buffer with all groups: position, normal, diffuse, specular and shininess, ambient,
/// emission, facet, lift.
inline constexpr std::size_t kGBufferBytesPerPixel = (3 + 3 + 3 + 4 + 3 + 3 + 1 + 1) * sizeof(float);

/// A light: as the scene has it, as the kernels take it, and its share of the tree over the lights, 7 floats
/// a node and a node above for every kTreeArity.
inline constexpr std::size_t kBytesPerLight =
    sizeof(Light) + sizeof(ShadeLight) + 7 * sizeof(float) * kTreeArity / (kTreeArity - 1) + 1;

/// Of a pixel, at the most: where the light lists start, and what counting found.
inline constexpr std::size_t kListBytesPerPixel = 1 + kFoundPerTile * sizeof(ListEntry) / kTilePixels;

/// What a pixel of a band takes at the most, on the host and on a device that shares its memory: the
/// G-buffer's groups, colours, what --stats and the layers ask for, and its share of the light lists as far
/// as lights reach everywhere. Beside it a tile takes an entry of 8 bytes for each light that reaches it.
std::size_t bytesPerPixel(const RenderSettings& settings, const PlaneSet& planes, const FeatureSet& features,
                          const Scene& scene);

/// The height of bands, a multiple of kBinSize: all about the same, and as few as fit kBandBytes and a
/// quarter of what memory this process may still take.
int bandHeight(glm::ivec2 size, std::size_t bytes_per_pixel);

}  // namespace luciole
