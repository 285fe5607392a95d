#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <new>
#include <vector>

#include "kernels/shared.h"
#include "scene/scene.hpp"

namespace luciole {

/// Allocates on cache lines, so that a row of up to 16 float lanes is one aligned load and OpenCL can use the
/// memory in place.
template <class T>
struct CacheAligned {
  using value_type = T;
  static constexpr std::align_val_t kAlignment{128};
  CacheAligned() = default;
  template <class U>
  CacheAligned(const CacheAligned<U>&) {}
  T* allocate(std::size_t n) { return static_cast<T*>(::operator new(n * sizeof(T), kAlignment)); }
  void deallocate(T* p, std::size_t) { ::operator delete(p, kAlignment); }
  bool operator==(const CacheAligned&) const { return true; }
};

using Plane = std::vector<float, CacheAligned<float>>;

/// What the camera sees, one sample a pixel, laid out for the kernels.
///
///     tile (kTileSize × kTileSize pixels)      a plane group, here 3 components of `pixels()` floats each
///     ┌────────┬────────┬──────                ┌───────────────┬───────────────┬───────────────┐
///     │ 0      │ 1      │ 2                    │ x of tile 0,1…│ y of tile 0,1…│ z of tile 0,1…│
///     ├────────┼────────┼──────                └───────────────┴───────────────┴───────────────┘
///     │ tiles_x│ …      │                      inside a tile: row by row, kTileSize floats a row
///
/// Space is view space: the eye is the origin, x right, y up, −z ahead (metres), so precision does not depend
/// on where in the world the camera stands. A pixel that shows nothing, or lies in a tile beyond the
/// picture's edge, has position (0, 0, −inf) and zeros everywhere else. A group that no feature needs is
/// empty.
struct GBuffer {
  int width = 0;   ///< pixels
  int height = 0;  ///< pixels
  int tiles_x = 0;
  int tiles_y = 0;
  Plane position;              ///< x y z
  Plane normal;                ///< x y z, unit, turned towards the viewer on double-sided surfaces
  Plane diffuse;               ///< r g b, linear reflectance
  Plane specular;              ///< r g b and shininess; optional
  Plane ambient;               ///< r g b; optional
  Plane emission;              ///< r g b; optional
  Camera camera;               ///< whose view space this is
  glm::ivec2 picture_size{0};  ///< of the whole picture, of which this may be a crop
  glm::ivec2 crop_origin{0};   ///< where in the whole picture pixel (0,0) lies

  /// Pixels in a plane, tiles beyond the edge included.
  std::size_t pixels() const { return std::size_t(tiles_x) * tiles_y * kTilePixels; }

  /// The place in a plane of pixel (x, y), counted from the top left.
  std::size_t index(int x, int y) const {
    const std::size_t tile = std::size_t(y / kTileSize) * tiles_x + x / kTileSize;
    return tile * kTilePixels + std::size_t(y % kTileSize) * kTileSize + x % kTileSize;
  }
};

}  // namespace luciole
