#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "gbuffer/layouts.hpp"
#include "luciole/gbuffer.hpp"
#include "luciole/image.hpp"

namespace luciole {

/// The user's choices for a file.
struct GBufferRequest {
  ChosenLayers layers{};
  std::optional<FileSpace> space{};
  std::optional<glm::dmat4> camera_to_world{};  ///< a rigid motion, camera space as in Camera
  std::optional<Camera> camera{};               ///< for files without a camera
  /// Reflectances become coefficients of light in watts a steradian: Kd is diffuse / π, and Ks is
  /// specular · (n + 2) / 2π, which makes (R·V)ⁿ reflect that share (E. Lafortune and Y. Willems, "Using the
  /// Modified Phong Reflectance Model for Physically Based Rendering", 1994).
  bool albedo = false;
  bool color = false;  ///< also read the picture itself
};

struct GBufferInput {
  GBuffer gbuffer;
  Image color;                     ///< R G B, and A where the file has it; empty unless asked for
  std::vector<std::string> notes;  ///< lines for the user: the layers found and the assumptions made
};

/// Reads a G-buffer from a file that this program or another wrote: an EXR of one part or several, tiles or
/// rows, halves or floats. Which layers are which findLayers() says. All parts that are read must be of one
/// size and place.
///
/// A pixel is background if its normal or, without normals, its position is zero, if either isn't finite, or
/// if its depth isn't, or is 10¹⁰ exactly or 10²⁰ or more: so Blender and Arnold write infinity. Without
/// positions they are rebuilt from the depth (of either sign) and the camera, and normals from positions (see
/// rebuildNormals()). Normals are normalized. Coefficients below 0 become 0. Missing layers read as: diffuse
/// 0.8, specular 0, shininess 0, ambient = diffuse. Specular is left out if another program's file has no
/// shininess. Without emission, geometric normals or lift these groups stay empty; without lift shadow tests
/// start at the position. Geometric normals are left out beside unbent ones. Where one of either is zero or
/// not finite, the normal takes its place. This program's own planes in view space are used with its own
/// camera attributes only.
///
/// Throws InputError, a line that names the file and the channel, also where a coefficient of a surface isn't
/// finite; MachineError where the picture doesn't fit into memory.
GBufferInput readGBuffer(const std::string& path, const GBufferRequest& request);

}  // namespace luciole
