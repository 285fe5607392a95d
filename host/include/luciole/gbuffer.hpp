#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <vector>

#include "luciole/array_memory.hpp"
#include "luciole/image.hpp"
#include "luciole/scene.hpp"

namespace luciole {

/// One component or several of a G-buffer, one after another: `pixels()` floats each.
using Plane = std::vector<float, ArrayAllocator<float>>;
/// A plane of unit normals, octahedral: x in the lower 16 bits, y in the upper 16, both signed, in steps of
/// 1/32767. The square is the octahedron |x| + |y| + |z| = 1 seen from +z, with its far half folded outwards
/// (Meyer et al., "On floating-point normal vectors", 2010).
using PackedNormals = std::vector<std::uint32_t, ArrayAllocator<std::uint32_t>>;
/// A plane of reflection models: 0 where a surface has the picture's, else modelNumber() of its own.
using ModelPlane = std::vector<std::uint32_t, ArrayAllocator<std::uint32_t>>;
/// A plane of indices into a list of the scene.
using IndexPlane = std::vector<std::uint32_t, ArrayAllocator<std::uint32_t>>;
/// Stands for no element in an IndexPlane.
inline constexpr std::uint32_t kNoIndex = 0xffffffffu;

/// Bits 0 to 3 of v, moved to bits 0, 2, 4 and 6.
constexpr std::size_t everyOtherBit(std::size_t v) {
  v = (v | v << 2) & 0x33;
  return (v | v << 1) & 0x55;
}

/// The surfaces that a camera sees, one sample a pixel, laid out for the kernels.
///
///     tile (kTileSide × kTileSide pixels)      a plane group, here 3 components of `pixels()` floats each
///     ┌────────┬────────┬──────                ┌───────────────┬───────────────┬───────────────┐
///     │ 0      │ 1      │ 2                    │ x of tile 0,1…│ y of tile 0,1…│ z of tile 0,1…│
///     ├────────┼────────┼──────                └───────────────┴───────────────┴───────────────┘
///     │ tiles_x│ …      │                      inside a tile: in Z order (G. Morton, 1966), so that
///     └────────┴────────┴──────                each square of 2, 4 or 8 pixels a side, and with it
///                                              every row of lanes, lies in one piece
///
/// Space is view space: the eye is the origin, x right, y up, −z ahead (metres), so precision does not depend
/// on where in the world the camera stands. A pixel that shows nothing, or lies in a tile beyond the
/// picture's edge, has position (0, 0, −inf), kNoIndex for indices, and zeros everywhere else. A group that
/// no feature needs is empty.
struct GBuffer {
  int width = 0;   ///< pixels
  int height = 0;  ///< pixels
  int tiles_x = 0;
  int tiles_y = 0;
  Plane position = {};  ///< x y z
  Plane normal = {};    ///< x y z, unit, turned towards the viewer on double-sided surfaces
  Plane diffuse = {};   ///< r g b, linear reflectance
  Plane specular = {};  ///< r g b and shininess; optional
  Plane ambient = {};   ///< r g b; optional
  Plane emission = {};  ///< r g b; optional
  /// The triangle's own, on the side that `normal` was turned to; optional.
  PackedNormals geometric_normal = {};
  /// Instead of geometric_normal, never beside it: the interpolated normal that normal maps bent to `normal`.
  /// Lights that stand behind it are not seen, even by a bent normal that faces them.
  PackedNormals unbent_normal = {};
  /// Metres along `normal`, ≥ 0, to the point where shadow tests start; optional. That is near the smooth
  /// surface which the vertex normals describe, so that facets don't shadow themselves at the terminator
  /// (J. Hanika, "Hacking the Shadow Terminator", 2021).
  Plane lift = {};
  ModelPlane model = {};  ///< optional
  /// The direction in which the texture coordinate u grows, perpendicular to `normal`; optional. Where the
  /// surface has no such direction: what the normal alone gives, around the upright axis.
  PackedNormals tangent = {};
  Plane uv = {};               ///< u v, as Mesh::uvs; zeros where the mesh has none; optional
  IndexPlane object = {};      ///< in Scene::objects; optional
  IndexPlane material = {};    ///< in Scene::materials; optional
  Camera camera = {};          ///< defines view space
  bool knows_camera = true;    ///< false: a file without a camera, or without its field of view
  glm::ivec2 picture_size{0};  ///< of the whole picture, of which this may be a crop
  glm::ivec2 crop_origin{0};   ///< where in the whole picture pixel (0,0) lies
  Display display{};           ///< of the file that it was read from

  static constexpr int kTileSide = 16;  ///< pixels; tiles_x · kTileSide ≥ width

  /// Pixels in a plane, tiles beyond the edge included.
  std::size_t pixels() const { return std::size_t(tiles_x) * tiles_y * kTileSide * kTileSide; }

  /// The place in a plane of pixel (x, y), counted from the top left.
  std::size_t index(int x, int y) const {
    const std::size_t tile = std::size_t(y / kTileSide) * tiles_x + x / kTileSide;
    return tile * kTileSide * kTileSide + 2 * everyOtherBit(y % kTileSide) + everyOtherBit(x % kTileSide);
  }
};

/// The optional groups of a G-buffer that are to be filled.
struct PlaneSet {
  bool specular = false;
  bool ambient = false;
  bool emission = false;
  bool geometric_normal = false;
  bool unbent_normal = false;  ///< instead of geometric_normal
  bool lift = false;
  bool model = false;
  bool tangent = false;
  bool uv = false;
  bool object = false;
  bool material = false;
};

}  // namespace luciole
