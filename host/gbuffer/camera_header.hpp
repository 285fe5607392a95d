#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <string>

#include "image/image.hpp"
#include "scene/scene.hpp"

// The camera in the header of an EXR file, as OpenEXR's standard attributes define it
// (ImfStandardAttributes.h):
//
//   worldToCamera  camera space is left-handed as in RenderMan: x right, y up, +z ahead
//   worldToNDC     x and y from (0,0) at the display window's top left to (1,1) at its bottom right
//
// Both are 32-bit float, for points that are row vectors (point × matrix), which in memory is the same as
// GLM's column vectors and column-major matrices. Attributes of our own keep what those lose, as text with
// all digits of a double:
//
//   luciole:cameraToWorld  16 numbers, column after column; camera space as in Camera, −z ahead
//   luciole:projection     "perspective FOV_Y NEAR FAR" or "parallel HALF_HEIGHT NEAR FAR", radians and
//   metres luciole:cameraName
namespace luciole {

struct CameraHeader {
  Camera camera;
  bool is_exact = false;  ///< read from attributes of our own
  /// Half the whole picture's width and height at distance 1 (perspective) or in metres (parallel view);
  /// empty where the header does not tell, or not of a projection centred in the picture.
  std::optional<glm::dvec2> half_extent;
};

/// picture_size: of the whole picture.
ExrAttributes cameraAttributes(const Camera& camera, glm::ivec2 picture_size);

/// Empty where the header has no camera. Some programs let worldToCamera look along −z; the sign of w in
/// worldToNDC tells which it is, or else where most of `visible_points` (world space; may be none) lie, or
/// else the handedness, taking the world to be right-handed. Throws InputError for a camera that is no rigid
/// motion, or text that can't be read. `path` is for messages; names are found in any case.
std::optional<CameraHeader> readCamera(const ExrAttributes& attributes, glm::ivec2 picture_size,
                                       const std::string& path, std::span<const glm::dvec3> visible_points);

}  // namespace luciole
