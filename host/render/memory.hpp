#pragma once

#include <cstddef>

#include "kernels/shared.h"
#include "luciole/scene.hpp"
#include "raster/shading_points.hpp"
#include "render/plan.hpp"

// The memory of pictures and lights, computed from the sizes of their parts.
namespace luciole {

/// A picture is rendered in bands of whole rows, whose pixels take at most so many bytes. That is enough that
/// the work done again for each band, mostly the transformation of all vertices, hardly counts. Larger bands
/// would be slower, because fresh memory is slow.
inline constexpr std::size_t kBandBytes = std::size_t(512) << 20;

/// A pixel of a G-buffer with all groups: position, normal, diffuse, specular and shininess, ambient,
/// emission, geometric or unbent normal, lift.
inline constexpr std::size_t kGBufferBytesPerPixel =
    (3 + 3 + 3 + 4 + 3 + 3 + 1 + 1 + 1 + 1 + 2 + 1 + 1) * sizeof(float);

/// A light: as the scene has it, as the kernels take it, and its share of the tree over the lights, which has
/// 7 floats a node and a node for every kTreeArity below it.
inline constexpr std::size_t kBytesPerLight =
    sizeof(Light) + sizeof(ShadeLight) + 7 * sizeof(float) * kTreeArity / (kTreeArity - 1) + 1;

/// A pixel's share, rounded up, of what a tile's light list takes beside its entries: its start, and what
/// counting found.
inline constexpr std::size_t kListBytesPerPixel = 1 + kFoundPerTile * sizeof(ListEntry) / kTilePixels;

/// A pass over SharedSamples::further lights at most one point for so many pixels of the band.
inline constexpr std::size_t kPixelsAPoint = 4;

/// A pixel's bytes beside the G-buffer's where samples share points: one ShadingPoint and as much that
/// its list has grown in advance, the object (4) and number of samples (2) of its first point, whether it is
/// uneven (1), and the place of its labels (4).
inline constexpr std::size_t kPointBytesPerPixel = 2 * sizeof(ShadingPoint) + 4 + 2 + 1 + 4;

/// Upper bound of the bytes that a pixel of a band takes, on the host and on a device that shares its memory:
/// the G-buffer's groups, colours, counts, layers, and its share of the list entries of lights that reach
/// everywhere. Not included are the entries of other lights, 8 bytes each, and points of a pixel beyond the
/// second. plan: all members before pixel_bytes must be set.
std::size_t bytesPerPixel(const Scene& scene, const RenderSettings& settings, const PicturePlan& plan);

/// Whether samples that see the same surface share a shading point.
bool sharesSamples(const RenderSettings& settings);

/// The most points in a pass over a band of so many pixels.
std::size_t pointsAPass(std::size_t pixels);

/// The height of the bands of a picture of `size` pixels, in rows: a multiple of kBinSize. There are as few
/// bands as fit into kBandBytes and into a quarter of the memory that this process may still take, all about
/// equally high.
int bandHeight(glm::ivec2 size, std::size_t bytes_per_pixel);

}  // namespace luciole
