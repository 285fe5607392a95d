#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <span>

// The visible points of a picture lie on the rays through their pixels. From that follow the space of a
// file's positions and the camera's field of view.
namespace luciole {

/// A point and the pixel that shows it.
struct SeenPoint {
  glm::dvec3 point;
  glm::dvec2 screen;  ///< the pixel's centre: −1 to 1 from the whole picture's left to its right and from its
                      ///< bottom to its top
};

/// A perspective camera at the origin that looks along an axis z.
struct RayFit {
  glm::dvec2 half_extent;  ///< half the picture's width and height at distance 1, > 0
  glm::dvec3 signs;        ///< 1 or −1: point × signs has x to the right, y up and −z ahead
  bool is_deep = false;    ///< the points' depths differ by more than a twentieth, so the fit is significant
};

/// The camera without shift that sees the points in their pixels, if there is one. Needs 16 points, nine in
/// ten of which must be less than 1.5 pixels off; others may be averages over a pixel at an edge.
/// `picture_size`: pixels of the whole picture.
std::optional<RayFit> fitRays(std::span<const SeenPoint> points, const glm::dvec2& picture_size);

/// Whether points in view space (−z ahead) lie on their pixels' rays, to the same extent. half_extent: as in
/// CameraHeader. shift: as in Camera. False where there are fewer than 16.
bool lieOnRays(std::span<const SeenPoint> points, glm::dvec2 picture_size, glm::dvec2 half_extent,
               glm::dvec2 shift, bool parallel);

}  // namespace luciole
