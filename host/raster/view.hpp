#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "luciole/settings.hpp"

namespace luciole {

/// Which of how many samples of a pixel.
struct SampleNumber {
  int index = 0;
  int count = 1;
};

/// A pinhole or parallel view and the part of its picture to draw.
struct View {
  glm::dmat4 world_to_view{1.0};  ///< rigid; view space as in Camera
  /// View space to clip space: x and y in [−w, w] inside the picture, y up; z in [0, w] with reversed depth,
  /// 1 at the near plane and 0 at the far plane, since floats are finest near 0.
  glm::dmat4 projection{1.0};
  double pixel_aspect = 1;    ///< Camera::pixel_aspect, which `projection` contains
  glm::ivec2 size{0};         ///< of the whole picture, pixels
  glm::ivec2 crop_origin{0};  ///< top left pixel of the part to draw
  glm::ivec2 crop_size{0};
  glm::dvec2 sample{0.5};  ///< where in a pixel the sample lies, from its top left corner, in [0,1)²
  SampleNumber number;     ///< of that sample, for surfaces that are blended (blendThreshold)
  /// With several samples in one pass: the largest offset of a sample from `sample`, right and down, in 1/256
  /// pixel (see SamplePattern).
  glm::ivec2 reach{0};
};

/// Reversed-depth projections (see View::projection). `fov_y` in radians, `aspect` width / height, lengths in
/// metres; `near` and `far` are distances ahead, and the far plane of a perspective one may be infinitely
/// far.
glm::dmat4 perspectiveProjection(double fov_y, double aspect, double near, double far);
glm::dmat4 orthographicProjection(double left, double right, double bottom, double top, double near,
                                  double far);

/// The inverse of camera_to_world: the transposed rotation, so that no rounding of an inversion enters.
glm::dmat4 worldToView(const Camera& camera);

/// A rectangle of the whole picture's pixels.
struct PixelRectangle {
  glm::ivec2 first;
  glm::ivec2 end;

  bool contains(const glm::ivec2& at) const {
    return at.x >= first.x && at.y >= first.y && at.x < end.x && at.y < end.y;
  }
};

/// The view of a camera on a picture of `size` pixels, or on a part of it, sampled at pixel centres.
/// pixel_aspect: of the picture (see Display), beside the camera's own. Throws InputError for a crop that is
/// not inside the picture.
View cameraView(const Camera& camera, glm::ivec2 size, const std::optional<Crop>& crop = {},
                double pixel_aspect = 1);

/// Where in a pixel sample `index` of `count` lies: the Hammersley set, shifted so that a single sample is
/// the centre.
glm::dvec2 samplePoint(int index, int count);

/// Sets the view to a sample of its pixels, at samplePoint().
void takeSample(View& view, const SampleNumber& number);

/// The camera of a view: the inverse of cameraView, without the name.
Camera viewCamera(const View& view);

}  // namespace luciole
