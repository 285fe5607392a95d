#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "luciole/array_memory.hpp"
#include "raster/geometry.hpp"
#include "raster/placed_meshlets.hpp"

namespace luciole {

/// A triangle ready to be drawn. Coordinates start at the sample of the whole picture's pixel (0,0), whatever
/// the crop, so that a crop gives the same numbers. 64 bytes.
struct RasterTriangle {
  std::int32_t x[3];  ///< corners in 1/256 pixel; clockwise as seen on the picture (y down), area > 0
  std::int32_t y[3];
  float depth_low;  ///< the corners' range of reversed depth
  float depth_high;
  double depth;  ///< reversed depth at pixel (0,0), and its steps a pixel
  double depth_dx;
  double depth_dy;
  std::uint32_t triangle;  ///< number among all; several pieces may have the same
  bool masked;             ///< its material has holes
};
static_assert(sizeof(RasterTriangle) == 64);

constexpr int kSubpixelBits = 8;
constexpr int kSubpixels = 1 << kSubpixelBits;

enum class FaceCulling : std::uint8_t { kNone, kBackFaces };

using RasterTriangles = RawArray<RasterTriangle>;

struct RasterSetup {
  RasterTriangles triangles;  ///< in object and triangle order
  std::uint64_t back_facing = 0;
  std::vector<RasterTriangles> parts;  ///< memory of the tasks' outputs
};

/// Culls, clips, projects and snaps the triangles of the runs seen, in parallel. Keeps those whose bounding
/// boxes contain a sample of the view's crop. `recycled`: its memory is reused. O(triangles).
RasterSetup setupTriangles(const Scene& scene, const Geometry& geometry, const View& view,
                           FaceCulling culling, RasterSetup recycled = {});

/// The same for the meshlets chosen, which it transforms itself. No face is culled.
RasterSetup setupMeshlets(const Scene& scene, const PlacedMeshlets& placed, const View& view);

struct RasterCounts;
/// Sets the counts of a picture of so many triangles; RasterCounts::covering must be there.
void setCounts(std::uint32_t triangle_count, const RasterSetup& setup, RasterCounts& counts);

/// The pixels whose samples a triangle may cover: those in its bounding box, `last` included; empty where
/// first > last. A sample exactly on the right or bottom edge belongs to the neighbouring triangle. `reach`:
/// as in View.
struct PixelBox {
  glm::ivec2 first;
  glm::ivec2 last;
};
inline PixelBox pixelBox(const RasterTriangle& triangle, const glm::ivec2& reach) {
  const std::int32_t* x = triangle.x;
  const std::int32_t* y = triangle.y;
  const glm::ivec2 up = kSubpixels - 1 - reach;
  return {{(std::min(std::min(x[0], x[1]), x[2]) + up.x) >> kSubpixelBits,
           (std::min(std::min(y[0], y[1]), y[2]) + up.y) >> kSubpixelBits},
          {(std::max(std::max(x[0], x[1]), x[2]) - 1) >> kSubpixelBits,
           (std::max(std::max(y[0], y[1]), y[2]) - 1) >> kSubpixelBits}};
}

}  // namespace luciole
