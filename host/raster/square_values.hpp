#pragma once

#include <glm/glm.hpp>

#include "raster/sample_texture.hpp"
#include "raster/seen_surface.hpp"
#include "raster/square.hpp"

namespace luciole {

/// What a square's pixels show, in the groups of a G-buffer.
struct SquareValues {
  Lanes3<float> position;
  Lanes3<float> normal;
  Lanes3<float> diffuse;
  std::array<Lanes<float>, 4> specular;
  Lanes3<float> ambient;
  Lanes3<float> emission;
  Lanes<std::uint32_t> geometric_normal;
  Lanes<float> lift;
  /// The maps that are still to be multiplied in.
  Lanes<const TextureUse*> reflection_map;  ///< into diffuse and ambient; null: none
  Lanes<const TextureUse*> emission_map;
  SquareFootprints footprints;
  SquareFootprints emission_footprints;
};

/// Where a square's pixels look, as by ViewPlane::at.
struct SquarePlace {
  Lanes<double> x;
  Lanes<double> y;
};
SquarePlace squarePlace(const ViewPlane& plane, const glm::ivec2& first_pixel);

/// What all of a square's pixels would show of a surface's plane, and those that see the surface show of it.
SquareValues valuesOf(const ResolveInput& input, const SeenSurface& seen, const SquarePlace& place,
                      const LaneMask& sees_it);

/// Takes over the values of the pixels that see a surface.
void put(const SquareValues& values, const LaneMask& sees_it, SquareValues& out);

/// Multiplies the maps in.
void applyMaps(const Scene& scene, SquareValues& values);

}  // namespace luciole
