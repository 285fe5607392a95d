#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "raster/clip_polygon.hpp"
#include "raster/placed_meshlets.hpp"
#include "raster/view.hpp"
#include "scene/scene.hpp"

namespace luciole {

/// The part of a triangle in or near the picture: a convex polygon of either winding. Small triangles and
/// back faces are kept. Corners are x and y in texels from the centre of the whole picture's texel (0,0), and
/// reversed depth.
struct BoundPiece : Polygon<glm::dvec3, 7> {
  glm::dvec3 low, high;  ///< the box of its corners
  double place_error;    ///< bound for its corners, texels in x and in y
  double depth_error;
  bool covering;  ///< it may cover whole texels: solid, large enough, and known well enough. Then:
  double depth, step_x, step_y;  ///< its plane: depth at corner `base`, and steps a texel
  int base;
};

struct BoundSetup {
  std::vector<BoundPiece> pieces;  ///< in the order of meshlets and triangles
  bool unknown = false;            ///< some triangle may be anywhere
};

/// Projects triangles without snapping their corners, and bounds the rounding errors of double precision.
/// Triangles with corners that aren't finite as floats are left out. Unlike setupTriangles it keeps what
/// reaches behind the near plane, with depths beyond 1.
BoundSetup setupBounds(const Scene& scene, const PlacedMeshlets& placed, const View& view);

}  // namespace luciole
