#pragma once

#include <array>
#include <cstdint>

#include "raster/lift.hpp"
#include "raster/resolve.hpp"
#include "raster/surface.hpp"

namespace luciole {

/// A value of a triangle's corners: the first one's, and the ways from there to the others'. At weights b it
/// is first + b1 · to_second + b2 · to_third.
template <class T>
struct Interpolant {
  T first{0.0};
  T to_second{0.0};
  T to_third{0.0};
};

/// A surface with all that its pixels need of its corners.
struct SeenSurface {
  Surface surface;
  glm::dvec3 facing_normal{0.0};       ///< its own, on the viewer's side
  std::uint32_t geometric_normal = 0;  ///< that, by packNormal()
  Interpolant<glm::dvec3> normal;      ///< on the viewer's side, of any length
  Lift lift;                           ///< where asked for
  Interpolant<glm::dvec2> uv;          ///< zero where no map needs them
  bool glows_apart = false;            ///< the emission map is looked up elsewhere:
  Interpolant<glm::dvec2> emission_uv;
  bool colored = false;
  Interpolant<glm::dvec3> color;  ///< where colored: of the vertices, or what light makes of them
};
SeenSurface seeSurface(const ResolveInput& input, std::uint32_t triangle);

/// The surfaces of the triangles seen last, by their number's lowest bits: neighbours mostly have numbers
/// near each other.
class SurfaceCache {
 public:
  explicit SurfaceCache(const ResolveInput& input) : input_(input) { triangles_.fill(kNoTriangle); }
  const SeenSurface& operator[](std::uint32_t triangle) {
    const std::size_t slot = triangle % kSlots;
    if (triangles_[slot] != triangle) {
      surfaces_[slot] = seeSurface(input_, triangle);
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
