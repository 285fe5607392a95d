#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>

#include "luciole/gbuffer.hpp"
#include "luciole/scene.hpp"
#include "raster/view.hpp"

namespace luciole {

/// Snapping corners to the rasterizer's grid may move an edge across a sample that is at most so many pixels
/// away.
inline constexpr double kEdgePixels = 1.0 / 256;

/// How a G-buffer differs from what a ray through each pixel's sample hits.
struct GBufferCheck {
  std::uint64_t pixels = 0;
  /// Largest errors over the pixels that show the surface which the ray hits, farther than kEdgePixels from
  /// its triangle's edges: as a share of the distance from the eye, and in radians.
  double position_error = 0, normal_error = 0;
  double bent_normal_error = 0;  ///< radians, of normals that a map bends, and of no others
  double lift_error = 0;         ///< likewise, as a share of the distance, where the G-buffer has lifts
  /// Numbers of pixels whose surface isn't the one that the ray hits, or where only one of the two is
  /// background, by reason.
  std::uint64_t beside_edges = 0;  ///< an edge of one of the two is within kEdgePixels: snapping explains it
  std::uint64_t at_ties = 0;  ///< both are within 10⁻⁶ of their distance from each other: rounding decides
  std::uint64_t unexplained = 0;
  glm::ivec2 worst_pixel{0};  ///< an unexplained one, if any, else that of the largest position error
};

/// Compares a G-buffer with rays through some pixels, counted from the top left of the view's crop. Embree
/// finds the triangles that a ray hits; points and normals are computed from the scene in double. The
/// G-buffer must have been rasterized from this view with Shading::kPhong and all objects, also those that
/// the fog hides.
GBufferCheck checkGBuffer(const Scene& scene, const View& view, const GBuffer& gbuffer,
                          std::span<const glm::ivec2> pixels);

}  // namespace luciole
