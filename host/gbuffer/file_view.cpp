#include "gbuffer/file_view.hpp"

#include <cmath>
#include <vector>

#include "gbuffer/camera_header.hpp"
#include "luciole/error.hpp"

namespace luciole {
namespace {

std::vector<SeenPoint> transformed(std::span<const SeenPoint> points, const glm::dmat4& by) {
  std::vector<SeenPoint> moved(points.begin(), points.end());
  for (SeenPoint& seen : moved) seen.point = glm::dvec3(by * glm::dvec4(seen.point, 1.0));
  return moved;
}

glm::dmat4 scaled(const glm::dvec3& factors) {
  glm::dmat4 matrix{1.0};
  for (int i = 0; i < 3; ++i) matrix[i][i] = factors[i];
  return matrix;
}

/// Takes over the lens of a camera, with this opening.
void setOpening(const glm::dvec2& half_extent, const Camera& lens, FileView& view) {
  view.knows_camera = true;
  view.half_extent = half_extent;
  view.camera.shift = lens.shift;
  view.camera.pixel_aspect = lens.pixel_aspect;
  view.camera.orthographic = lens.orthographic;
  if (lens.orthographic)
    view.camera.half_height = half_extent.y;
  else
    view.camera.fov_y = 2 * std::atan(half_extent.y);
}

std::optional<CameraHeader> headerCamera(const FileViewInput& input) {
  std::vector<glm::dvec3> world;
  if (input.space.value_or(input.usual) == FileSpace::kWorld)
    for (const SeenPoint& seen : input.points) world.push_back(seen.point);
  return readCamera(input.attributes, input.picture_size, input.path, world, input.pixel_aspect);
}

bool liesInWorldSpace(const FileViewInput& input, const std::optional<CameraHeader>& header) {
  if (!header || !header->half_extent) return false;
  return lieOnRays(transformed(input.points, glm::inverse(header->camera.camera_to_world)),
                   input.picture_size, *header->half_extent, header->camera.shift,
                   header->camera.orthographic);
}

}  // namespace

FileView findView(const FileViewInput& input) {
  const glm::dvec2 size = input.picture_size;
  const std::optional<CameraHeader> header = headerCamera(input);
  FileView view;
  if (header && header->is_exact && !input.camera_to_world) {
    view.camera = header->camera;
    view.knows_camera = true;
    view.half_extent = *header->half_extent;
    view.camera_source = "the file's";
    view.in_view_space = input.has_view_space;
    view.space = input.space.value_or(FileSpace::kWorld);
    view.to_view =
        view.space == FileSpace::kCamera ? glm::dmat4(1.0) : glm::inverse(view.camera.camera_to_world);
    return view;
  }

  const std::optional<RayFit> rays = fitRays(input.points, size);
  const bool has_camera = input.camera_to_world || header || input.camera;
  view.space = input.usual;
  if (input.space)
    view.space = *input.space;
  else if (liesInWorldSpace(input, header))
    view.space = FileSpace::kWorld;
  else if (rays && rays->is_deep && has_camera)
    view.space = FileSpace::kCamera;
  if (view.space == FileSpace::kCamera && !has_camera)
    throw InputError(
        input.path +
        ": positions are in camera space, and no camera tells where that is: expected one in the "
        "header, or request.camera_to_world or request.camera");

  if (header) view.camera = header->camera;
  if (header && header->half_extent) setOpening(*header->half_extent, header->camera, view);
  view.camera_source = "the file's";
  if (input.camera_to_world) {
    view.camera.camera_to_world = *input.camera_to_world;
    view.camera_source = "as told";
  } else if (!header && input.camera) {
    view.camera = *input.camera;
    view.camera_source = "the scene's";
  } else if (!header) {
    view.camera_source = "unknown, the eye is taken to be at the origin";
  }

  if (view.space == FileSpace::kCamera) {
    // Without a fit a point decides the side. The file's camera, but not a typed one, has the same axes as
    // the positions.
    const bool is_behind = !input.points.empty() && input.points.front().point.z > 0;
    const glm::dvec3 signs = rays ? rays->signs : glm::dvec3(1, 1, is_behind ? -1 : 1);
    view.to_view = scaled(signs);
    if (header && !input.camera_to_world)
      view.camera.camera_to_world = view.camera.camera_to_world * scaled({signs.x, signs.y, 1.0});
  } else {
    view.to_view = glm::inverse(view.camera.camera_to_world);
  }

  const std::vector<SeenPoint> seen = transformed(input.points, view.to_view);
  const bool is_scenes = !header && !input.camera_to_world && input.camera;
  if (!view.knows_camera && !is_scenes && has_camera)
    if (const auto fit = fitRays(seen, size); fit && fit->signs == glm::dvec3(1.0))
      setOpening(fit->half_extent, Camera{}, view);
  if (!view.knows_camera && input.camera)
    setOpening(halfExtent(*input.camera, input.picture_size, input.pixel_aspect), *input.camera, view);
  if (!input.has_positions && !view.knows_camera)
    throw InputError(input.path +
                     ": attribute worldToNDC: depth without positions needs worldToCamera and worldToNDC, or "
                     "request.camera");
  if (view.knows_camera && !seen.empty() &&
      !lieOnRays(seen, size, view.half_extent, view.camera.shift, view.camera.orthographic))
    view.camera_source += ", by which positions lie elsewhere than their pixels";
  return view;
}

}  // namespace luciole
