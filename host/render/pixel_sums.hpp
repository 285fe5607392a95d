#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>

#include "lighting/light_gbuffer.hpp"
#include "luciole/gbuffer.hpp"
#include "raster/shading_points.hpp"

namespace luciole {

/// Sums over the samples of a picture's pixels, in a G-buffer's layout. All but color may be empty.
struct PixelSums {
  Plane color;        ///< r g b
  Plane covered;      ///< samples that see a surface
  Plane shadings;     ///< points that were shaded
  Plane light_error;  ///< half widths of color's intervals, r g b
  Plane half_width;   ///< the parts of them that aren't proven, r g b
};

/// What sums hold beside light.
struct PointCounts {
  bool covered = false;
  bool shadings = false;
};

/// The sums over the first points of the pixels. layout: their G-buffer, whose planes may be empty. samples:
/// as in SharedSamples. lit: their light.
PixelSums firstPoints(const GBuffer& layout, std::span<const std::uint16_t> samples, LitPlanes lit,
                      const PointCounts& counts);

/// Adds the lit points of the lists from first_list up to end_list. lit: their planes, laid out as by
/// gatherPoints(), `stride` floats each.
void addPoints(const GBuffer& layout, const PointLists& points, std::size_t first_list, std::size_t end_list,
               const LitPlanes& lit, std::size_t stride, PixelSums& sums);

/// Adds the background's colour for the samples of a picture of so many samples a pixel that see no surface.
/// covered: as in PixelSums.
void addBackground(const glm::vec3& background, int samples, const Plane& covered, Plane& color);

/// The same of a background that differs from pixel to pixel: planes r g b.
void addBackground(const Plane& background, int samples, const Plane& covered, Plane& color);

}  // namespace luciole
