#include "raster/view.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "luciole/error.hpp"
#include "raster/geometry.hpp"

namespace luciole {

glm::dmat4 perspectiveProjection(double fov_y, double aspect, double near, double far) {
  const double scale = 1.0 / std::tan(0.5 * fov_y);
  glm::dmat4 projection(0.0);
  projection[0][0] = scale / aspect;
  projection[1][1] = scale;
  projection[2][2] = near / (far - near);
  projection[2][3] = -1.0;
  projection[3][2] = far < std::numeric_limits<double>::infinity() ? near * far / (far - near) : near;
  return projection;
}

glm::dmat4 orthographicProjection(double left, double right, double bottom, double top, double near,
                                  double far) {
  glm::dmat4 projection(0.0);
  projection[0][0] = 2.0 / (right - left);
  projection[1][1] = 2.0 / (top - bottom);
  projection[2][2] = 1.0 / (far - near);
  projection[3][0] = -(right + left) / (right - left);
  projection[3][1] = -(top + bottom) / (top - bottom);
  projection[3][2] = far / (far - near);
  projection[3][3] = 1.0;
  return projection;
}

glm::dmat4 worldToView(const Camera& camera) {
  const glm::dmat3 rotation = glm::transpose(glm::dmat3(camera.camera_to_world));
  glm::dmat4 to_view(rotation);
  to_view[3] = glm::dvec4(-(rotation * glm::dvec3(camera.camera_to_world[3])), 1.0);
  return to_view;
}

View cameraView(const Camera& camera, glm::ivec2 size, const std::optional<Crop>& crop, double pixel_aspect) {
  View view;
  view.world_to_view = worldToView(camera);
  const double aspect = camera.pixel_aspect * pixel_aspect * size.x / size.y;
  view.pixel_aspect = camera.pixel_aspect;
  if (camera.orthographic) {
    const double half_width = camera.half_height * aspect;
    view.projection = orthographicProjection(-half_width, half_width, -camera.half_height, camera.half_height,
                                             camera.near, camera.far);
    view.projection[3] += glm::dvec4(camera.shift, 0, 0);
  } else {
    view.projection = perspectiveProjection(camera.fov_y, aspect, camera.near, camera.far);
    view.projection[2] -= glm::dvec4(camera.shift, 0, 0);
  }
  view.size = size;
  view.crop_size = size;
  if (crop) {
    if (crop->x < 0 || crop->y < 0 || crop->width < 1 || crop->height < 1 || crop->width > size.x - crop->x ||
        crop->height > size.y - crop->y)
      throw InputError(fmt::format("settings.crop: {},{},{},{}: not inside the picture of {}x{} pixels",
                                   crop->x, crop->y, crop->width, crop->height, size.x, size.y));
    view.crop_origin = {crop->x, crop->y};
    view.crop_size = {crop->width, crop->height};
  }
  return view;
}

glm::dvec2 samplePoint(int index, int count) {
  // Radical inverse in base 2 (van der Corput); both coordinates are shifted by half of their finest step.
  double inverse = 0, step = 0.5;
  for (int bits = index; bits > 0; bits >>= 1, step /= 2)
    if (bits & 1) inverse += step;
  double finest = 1;
  while (finest > 1.0 / count) finest /= 2;
  return {(index + 0.5) / count, inverse + finest / 2};
}

void takeSample(View& view, const SampleNumber& number) {
  view.number = number;
  view.sample = samplePoint(number.index, number.count);
}

Camera viewCamera(const View& view) {
  Camera camera;
  const glm::dmat3 to_world = glm::transpose(glm::dmat3(view.world_to_view));
  camera.camera_to_world = glm::dmat4(to_world);
  camera.camera_to_world[3] = glm::dvec4(-(to_world * glm::dvec3(view.world_to_view[3])), 1.0);
  const glm::dmat4& projection = view.projection;
  const double scale = projection[2][2];
  const double offset = projection[3][2];
  camera.orthographic = projection[2][3] == 0.0;
  camera.shift = axisInPicture(view);
  camera.pixel_aspect = view.pixel_aspect;
  camera.far = offset / scale;
  if (camera.orthographic) {
    camera.half_height = 1.0 / projection[1][1];
    camera.near = (offset - 1.0) / scale;
  } else {
    camera.fov_y = 2.0 * std::atan(1.0 / projection[1][1]);
    camera.near = offset / (1.0 + scale);
  }
  return camera;
}

}  // namespace luciole
