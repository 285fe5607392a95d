#pragma once

#include <cstddef>

#include "kernels/shared.h"
#include "luciole/scene.hpp"
#include "raster/shading_points.hpp"
#include "render/plan.hpp"

// How much memory pictures and lights take, computed from the sizes of their parts.
namespace luciole {

/// A picture is rendered in bands of whole rows, whose pixels take at most so many bytes. That is enough that
/// the work done again for each band, mostly the transformation of all vertices, hardly counts. Larger bands
/// would be slower, because fresh memory is slow.
inline constexpr std::size_t kBandBytes = std::size_t(512) << 20;

/// A pixel of a G-buffer with all groups: position, normal, diffuse, specular and shininess, ambient,
/// emission, geometric or unbent normal, lift.
inline constexpr std::size_t kGBufferBytesPerPixel = (3 + 3 + 3 + 4 + 3 + 3 + 1 + 1) * sizeof(float);

/// A light: as the scene has it, as the kernels take it, and its share of the tree over the lights, which has
/// 7 floats a node and a node for every kTreeArity below it.
inline constexpr std::size_t kBytesPerLight =
    sizeof(Light) + sizeof(ShadeLight) + 7 * sizeof(float) * kTreeArity / (kTreeArity - 1) + 1;

/// A pixel's share, rounded up, of what a tile's light list takes beside its entries: its start, and what
/// counting found.
inline constexpr std::size_t kListBytesPerPixel = 1 + kFoundPerTile * sizeof(ListEntry) / kTilePixels;

/// Of the points beside each pixel's first that are shaded for its samples (SharedSamples), so many are lit
/// in a pass: one for every four pixels.
inline constexpr std::size_t kPixelsAPoint = 4;

/// A pixel's share of those points' list, while it is made, where there is one point more a pixel; and its
/// own: its first point's object and number of samples, whether it is uneven, and where its labels are.
inline constexpr std::size_t kPointBytesPerPixel = 2 * sizeof(ShadingPoint) + 4 + 2 + 1 + 4;

/// Upper bound of the bytes that a pixel of a band takes, on the host and on a device that shares its memory:
/// the G-buffer's groups, colours, what --stats and the layers need, and its share of the list entries of
/// lights that reach everywhere. Not in it: each tile's entries, of 8 bytes, for other lights that reach it,
/// and of points that are shaded for a pixel's samples those beyond the second.
/// plan: what comes before this figure.
std::size_t bytesPerPixel(const Scene& scene, const RenderSettings& settings, const PicturePlan& plan);

/// Whether samples that see the same surface are shaded once.
bool sharesSamples(const RenderSettings& settings);

/// How many points are lit in a pass, at most, of a band of so many pixels.
std::size_t pointsAPass(std::size_t pixels);

/// The height of the bands of a picture of `size` pixels, in rows: a multiple of kBinSize. There are as few
/// bands as fit into kBandBytes and into a quarter of the memory that this process may still take, all about
/// equally high.
int bandHeight(glm::ivec2 size, std::size_t bytes_per_pixel);

}  // namespace luciole
