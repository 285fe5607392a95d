#pragma once

#include <glm/glm.hpp>

#include "raster/sample_texture.hpp"
#include "raster/seen_surface.hpp"
#include "raster/square.hpp"

namespace luciole {

/// The attributes of a square's pixels, in the groups and units of a G-buffer.
struct SquareValues {
  Lanes3<float> position;
  Lanes3<float> normal;
  Lanes3<float> diffuse;
  std::array<Lanes<float>, 4> specular;
  Lanes3<float> ambient;
  Lanes3<float> emission;
  Lanes<std::uint32_t> surface_normal;  ///< unbent_normal where that is wanted, else geometric_normal
  Lanes<float> lift;
  /// Of the members below only those of ResolveInput::planes are set.
  Lanes<std::uint32_t> model;
  Lanes<std::uint32_t> tangent;  ///< of the pixels that see the surface
  std::array<Lanes<float>, 2> uv;
  Lanes<std::uint32_t> object;
  Lanes<std::uint32_t> material;
  /// The maps that applyMaps() multiplies in.
  bool mapped = false;  ///< any pixel has one; otherwise the members below are undefined
  Lanes<const TextureUse*> reflection_map{};  ///< into diffuse and ambient; null: none
  Lanes<const TextureUse*> emission_map{};
  SquareFootprints footprints{};
  SquareFootprints emission_footprints{};
};

/// ViewPlane::at of a square's pixels. spread: the standard deviation, in pixels, of the samples' places for
/// which a pixel is shaded; 0 for a single sample.
struct SquarePlace {
  Lanes<double> x;
  Lanes<double> y;
  Lanes<float> spread_x{};
  Lanes<float> spread_y{};
};
/// `first_pixel`: the square's top left one, in the whole picture.
SquarePlace squarePlace(const ViewPlane& plane, const glm::ivec2& first_pixel);

/// The attributes of a surface at a square's pixels. For pixels that aren't in `mask` they are those of the
/// plane, perhaps outside the triangle.
SquareValues valuesOf(const ResolveInput& input, const SeenSurface& seen, const SquarePlace& place,
                      const LaneMask& mask);

/// Copies the values of the pixels in `mask` to `out`. planes: as ResolveInput::planes.
void copyValues(const SquareValues& values, const LaneMask& mask, const PlaneSet& planes, SquareValues& out);

/// Multiplies the reflection map into diffuse and ambient, and the emission map into emission. A pixel that
/// is shaded for several samples takes the mean of four lookups, whose places have the samples' mean and
/// variance.
void applyMaps(const Scene& scene, const SquarePlace& place, SquareValues& values);

}  // namespace luciole
