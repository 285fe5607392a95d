#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>

#include "gbuffer/gbuffer.hpp"
#include "raster/view.hpp"
#include "scene/scene.hpp"

namespace luciole {

/// How far from a triangle's edge snapping to the rasterizer's grid may still move it over a pixel's sample.
inline constexpr double kEdgePixels = 1.0 / 256;

/// What a picture's G-buffer says, against what a ray through each sample meets.
struct GBufferCheck {
  std::uint64_t pixels = 0;
  /// Largest, farther than kEdgePixels from the triangle's edges, of pixels that show what the ray meets: as
  /// a share of the distance from the eye, and in radians.
  double position_error = 0, normal_error = 0;
  double lift_error = 0;  ///< likewise, as a share of the distance, where the G-buffer has lifts
  /// Pixels whose G-buffer shows another surface than the ray, or none where it meets one, and the other way
  /// round.
  std::uint64_t beside_edges = 0;  ///< within kEdgePixels of an edge of one of the two: snapping explains it
  std::uint64_t at_ties = 0;  ///< both lie within 10⁻⁶ of the distance: whose depth is nearer is rounding
  std::uint64_t unexplained = 0;
  glm::ivec2 worst_pixel{0};  ///< an unexplained one, if any, else that of the largest position error
};

/// Rays by Embree through some pixels, counted from the view's crop; the meeting points and normals in double
/// from the scene itself. The G-buffer was rasterized from this view with Shading::kPhong and every object of
/// the scene, whatever the fog hides.
GBufferCheck checkGBuffer(const Scene& scene, const View& view, const GBuffer& gbuffer,
                          std::span<const glm::ivec2> pixels);

}  // namespace luciole
