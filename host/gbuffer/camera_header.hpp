#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <string>

#include "luciole/image.hpp"
#include "luciole/scene.hpp"

// The camera in the header of an EXR file, as OpenEXR's standard attributes define it
// (ImfStandardAttributes.h):
//
//   worldToCamera  camera space is left-handed as in RenderMan: x right, y up, +z ahead
//   worldToNDC     x and y from (0,0) at the display window's top left to (1,1) at its bottom right
//
// Both are 32-bit float, for points as row vectors (point × matrix). Their layout in memory is that of GLM's
// column-major matrices for column vectors. Attributes of our own keep all digits of a double, as text:
//
//   luciole:cameraToWorld  16 numbers, column after column; camera space as in Camera, −z ahead
//   luciole:projection     "perspective FOV_Y NEAR FAR" or "parallel HALF_HEIGHT NEAR FAR"
//                          (FOV_Y in radians, lengths in metres)
//   luciole:lens           "SHIFT_X SHIFT_Y PIXEL_ASPECT", as in Camera; left out where it is "0 0 1"
//   luciole:cameraName     Camera::name
namespace luciole {

struct CameraHeader {
  Camera camera;
  bool is_exact = false;  ///< read from our own attributes, with all digits
  /// Half the whole picture's width and height at distance 1 (perspective) or in metres (parallel view);
  /// empty where the header doesn't tell.
  std::optional<glm::dvec2> half_extent;
};

/// Half a picture's width and height as this camera sees it, at distance 1 (perspective) or in metres
/// (parallel view). `pixel_aspect`: see Display.
glm::dvec2 halfExtent(const Camera& camera, glm::ivec2 picture_size, double pixel_aspect);

/// The attributes that describe a camera in a header. `picture_size`: of the whole picture, pixels.
ExrAttributes cameraAttributes(const Camera& camera, glm::ivec2 picture_size, double pixel_aspect = 1);

/// Whether a matrix is a rotation, or mirroring, and a translation, to within 1e-4.
bool isRigid(const glm::dmat4& matrix);

/// Reads the camera of a header; empty if there is none. Attributes of our own take precedence. In some
/// programs' files worldToCamera looks along −z. That is decided by the sign of w in worldToNDC; without that
/// attribute by the side on which most of `visible_points` lie (world space; may be empty); without these by
/// the handedness of worldToCamera, for a right-handed world. Transposed matrices, as pbrt's, are recognized.
/// Their worldToNDC has other units, so it isn't used for the field of view. `picture_size`: of the whole
/// picture. `path` is for messages. Names of attributes are matched in any case. Throws InputError for a
/// matrix that isn't a rotation (or mirroring) and a translation, and for text that can't be read.
std::optional<CameraHeader> readCamera(const ExrAttributes& attributes, glm::ivec2 picture_size,
                                       const std::string& path, std::span<const glm::dvec3> visible_points,
                                       double pixel_aspect = 1);

}  // namespace luciole
