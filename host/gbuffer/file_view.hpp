#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <string>

#include "gbuffer/layouts.hpp"
#include "gbuffer/pixel_rays.hpp"
#include "luciole/image.hpp"
#include "luciole/scene.hpp"

namespace luciole {

/// Facts about a file's camera and spaces before its pixels are read, and what the user says of them.
struct FileViewInput {
  const std::string& path;  ///< for messages
  const ExrAttributes& attributes;
  glm::ivec2 picture_size{0};
  double pixel_aspect = 1;              ///< see Display
  std::span<const SeenPoint> points{};  ///< some of its positions; empty if it has none
  FileSpace usual = FileSpace::kWorld;  ///< of the file's layout
  std::optional<FileSpace> space{};     ///< as the user says
  std::optional<glm::dmat4> camera_to_world{};
  std::optional<Camera> camera{};  ///< for files without a camera
  bool has_positions = true;       ///< rather than a depth alone
  bool has_view_space = false;     ///< the file also has this program's own planes in view space
};

/// The transform of a file's points to those of a G-buffer.
struct FileView {
  Camera camera;
  bool knows_camera = false;    ///< also how wide it sees
  glm::dvec2 half_extent{0.0};  ///< see CameraHeader; where knows_camera
  bool in_view_space = false;   ///< the file's own view-space planes are to be read, as they are
  glm::dmat4 to_view{1.0};      ///< from the file's positions
  FileSpace space = FileSpace::kWorld;
  std::string camera_source;  ///< a few words for the user: where the camera is from, and what fits it
};

/// Finds the camera: the user's, else the header's, else input.camera. Finds the space of positions: the
/// user's; else world space if they lie on their pixels' rays by the header's camera; else camera space if
/// they lie on rays from the origin; else input.usual. Without any camera view space is world space. Throws
/// InputError if positions are in camera space and there is no camera, if there are neither positions nor a
/// field of view, and as readCamera does.
FileView findView(const FileViewInput& input);

}  // namespace luciole
