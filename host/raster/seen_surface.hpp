#pragma once

#include <array>
#include <cstdint>

#include "raster/lift.hpp"
#include "raster/resolve.hpp"
#include "raster/surface.hpp"

namespace luciole {

/// A value given at a triangle's corners: the first corner's, and the differences of the others from it. At
/// weights b it is first + b1 · to_second + b2 · to_third.
template <class T>
struct Interpolant {
  T first{0.0};
  T to_second{0.0};
  T to_third{0.0};
};

/// A surface, and the attributes of its corners that its pixels interpolate.
struct SeenSurface {
  Surface surface;
  glm::dvec3 facing_normal{0.0};       ///< the triangle's normal, unit, on the viewer's side
  std::uint32_t geometric_normal = 0;  ///< facing_normal, by packNormal()
  Interpolant<glm::dvec3> normal;      ///< on the viewer's side, of any length
  Lift lift;                           ///< for ResolveInput::planes with lift
  bool mapped = false;                 ///< it has diffuse or emission maps and texture coordinates
  Interpolant<glm::dvec2> uv;          ///< if mapped or in ResolveInput::planes, and the mesh has it
  bool has_tangent = false;            ///< it is in ResolveInput::planes, and the mesh has it
  Interpolant<glm::dvec3> tangent;     ///< if has_tangent; of any length
  bool has_normal_map = false;         ///< for Shading::kPhong
  bool has_emission_uv = false;        ///< its emission map has other texture coordinates, emission_uv
  Interpolant<glm::dvec2> emission_uv;
  bool colored = false;           ///< it has vertex colours or lit vertices
  Interpolant<glm::dvec3> color;  ///< if colored: these colours
};
/// The surface of a triangle, by its number. O(log objects).
SeenSurface makeSeenSurface(const ResolveInput& input, std::uint32_t triangle);

/// A direct-mapped cache of the surfaces seen last, by the lowest bits of the triangle's number: neighbouring
/// triangles mostly have consecutive numbers. Not safe for several threads.
class SurfaceCache {
 public:
  explicit SurfaceCache(const ResolveInput& input) : input_(input) { triangles_.fill(kNoTriangle); }
  const SeenSurface& operator[](std::uint32_t triangle) {
    const std::size_t slot = triangle % kSlots;
    if (triangles_[slot] != triangle) {
      surfaces_[slot] = makeSeenSurface(input_, triangle);
      triangles_[slot] = triangle;
    }
    return surfaces_[slot];
  }

 private:
  static constexpr std::size_t kSlots = 128;
  const ResolveInput& input_;
  std::array<std::uint32_t, kSlots> triangles_;
  std::array<SeenSurface, kSlots> surfaces_;
};

}  // namespace luciole
