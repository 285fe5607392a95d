#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>

#include "luciole/gbuffer.hpp"
#include "raster/shading_points.hpp"

namespace luciole {

/// Sums over the samples of a picture's pixels, in a G-buffer's layout. All but color may be empty.
struct PixelSums {
  Plane color;        ///< r g b
  Plane covered;      ///< samples that see a surface
  Plane shadings;     ///< points that were shaded
  Plane light_error;  ///< bounds of color's errors, r g b
};

/// The sums over the first points of the pixels. layout: their G-buffer, whose planes may be empty. samples:
/// as in SharedSamples. lit: their colours, planes r g b and perhaps more. light_error: r g b, or empty.
PixelSums firstPoints(const GBuffer& layout, std::span<const std::uint16_t> samples, Plane lit,
                      Plane light_error);

/// Adds the lit points of the lists from first_list up to end_list. lit, light_error: their planes, laid out
/// as by gatherPoints(), `stride` floats each.
void addPoints(const GBuffer& layout, const PointLists& points, std::size_t first_list, std::size_t end_list,
               const Plane& lit, const Plane& light_error, std::size_t stride, PixelSums& sums);

/// Adds the background's colour for the samples of a picture of so many samples a pixel that see no surface.
/// covered: as in PixelSums.
void addBackground(const glm::vec3& background, int samples, const Plane& covered, Plane& color);

}  // namespace luciole
