#include "render/screens.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>
#include <vector>

#include "kernels/shared.h"
#include "lighting/count_picture.hpp"
#include "luciole/error.hpp"
#include "render/assemble.hpp"

namespace luciole {
namespace {

/// The planes that screens name. A name in a comment makes one that isn't read.
struct ScreenPlanes {
  bool from_eye = false, depth = false, normal = false, object = false, material = false;
};

ScreenPlanes planesOf(const std::vector<ScreenProgram>& screens) {
  ScreenPlanes planes;
  for (const ScreenProgram& screen : screens) {
    const auto names = [&](std::string_view name) {
      return screen.shader.text.find(name) != std::string::npos;
    };
    planes.from_eye |= names("position_at") || names("from_eye_at") || names("to_eye_at");
    planes.depth |= names("depth_at") || names("pixel_size_at");
    planes.normal |= names("normal_at");
    planes.object |= names("object_at");
    planes.material |= names("material_at");
  }
  return planes;
}

ScreenFrame frameOf(const GBuffer& gbuffer, const PixelRectangle& inner) {
  const Camera& camera = gbuffer.camera;
  const int row = (gbuffer.width + kScreenPad - 1) / kScreenPad * kScreenPad + 2 * kScreenPad;
  const glm::vec3 eye(camera.camera_to_world[3]), back(glm::normalize(camera.camera_to_world[2]));
  const double pixel =
      2 * (camera.orthographic ? camera.half_height : std::tan(camera.fov_y / 2)) / gbuffer.picture_size.y;
  const bool parallel = camera.orthographic;
  return {.eye = {eye.x, eye.y, eye.z, 0},
          .to_eye = parallel ? float4{back.x, back.y, back.z, 0} : float4{0, 0, 0, -1},
          .pixel_base = parallel ? float(pixel) : 0.0f,
          .pixel_slope = parallel ? 0.0f : float(pixel),
          .plane_stride = uint(row) * uint(gbuffer.height),
          .row_stride = row,
          .columns = gbuffer.width,
          .rows = gbuffer.height,
          .first_x = gbuffer.crop_origin.x,
          .first_y = gbuffer.crop_origin.y,
          .width = gbuffer.picture_size.x,
          .height = gbuffer.picture_size.y,
          .inner_left = inner.first.x,
          .inner_top = inner.first.y,
          .inner_right = inner.end.x,
          .inner_bottom = inner.end.y,
          .pad0 = 0,
          .pad1 = 0};
}

/// Calls visit(place in the G-buffer, place in planes of rows) for each pixel, in parallel.
template <class Visit>
void forEachPlace(const GBuffer& gbuffer, const ScreenFrame& frame, const Visit& visit) {
  tbb::parallel_for(0, gbuffer.height, [&](int y) {
    const std::size_t row = std::size_t(y) * std::size_t(frame.row_stride) + kScreenPad;
    for (int x = 0; x < gbuffer.width; ++x) visit(gbuffer.index(x, y), row + std::size_t(x));
  });
}

/// Makes rows go on beyond their ends as they end, in all planes.
template <class Values>
void padRows(const ScreenFrame& frame, Values& planes) {
  const std::size_t rows = planes.size() / std::size_t(frame.row_stride);
  tbb::parallel_for(std::size_t(0), rows, [&](std::size_t y) {
    const auto row = planes.begin() + std::ptrdiff_t(y) * frame.row_stride, first = row + kScreenPad,
               end = first + frame.columns;
    std::fill(row, first, *first);
    std::fill(end, row + frame.row_stride, end[-1]);
  });
}

/// `count` planes of rows. value(place, c): of plane c, for a pixel at that place in the G-buffer.
template <class T, class Value>
std::vector<T, ArrayAllocator<T>> layRows(const GBuffer& gbuffer, const ScreenFrame& frame, bool wanted,
                                          std::size_t count, const Value& value) {
  std::vector<T, ArrayAllocator<T>> planes;
  if (!wanted) return planes;
  planes.resize(count * frame.plane_stride);
  forEachPlace(gbuffer, frame, [&](std::size_t place, std::size_t out) {
    const auto values = value(place);
    for (std::size_t c = 0; c < count; ++c) planes[out + c * frame.plane_stride] = values[int(c)];
  });
  padRows(frame, planes);
  return planes;
}

}  // namespace

View withMargin(const View& view, const PicturePlan& plan) {
  if (plan.screens.empty()) return view;
  int radius = 0;
  for (const ScreenProgram& screen : plan.screens) radius += screen.radius;
  const int step = plan.pixels.lightError() ? int(kTileSize) : 1;
  View wide = view;
  wide.crop_origin = glm::max(view.crop_origin - radius, 0) / step * step;
  const glm::ivec2 end = view.crop_origin + view.crop_size + radius;
  wide.crop_size = glm::min((end + step - 1) / step * step, view.size) - wide.crop_origin;
  return wide;
}

ScreenedColors applyScreens(ReadyPicture& picture, const GBuffer& gbuffer, const Plane& color,
                            const PixelRectangle& inner) {
  OpenedDevice& device = picture.device;
  const ScreenPlanes wanted = planesOf(picture.plan.screens);
  const ScreenFrame frame = frameOf(gbuffer, inner);
  const std::size_t n = gbuffer.pixels();
  const glm::dmat3 to_world(gbuffer.camera.camera_to_world);
  const float exposure = std::exp2(picture.settings.exposure);
  const auto isSeen = [&](std::size_t place) { return std::isfinite(gbuffer.position[place + 2 * n]); };
  const auto vectorAt = [&](const Plane& plane, std::size_t place) {
    return glm::vec3(plane[place], plane[place + n], plane[place + 2 * n]);
  };
  Plane before = layRows<float>(gbuffer, frame, true, 3, [&](std::size_t place) {
    const glm::vec3 exposed = vectorAt(color, place) * exposure;
    return glm::vec3(finiteColor(exposed.x), finiteColor(exposed.y), finiteColor(exposed.z));
  });
  const Plane from_eye = layRows<float>(gbuffer, frame, wanted.from_eye, 3, [&](std::size_t place) {
    return isSeen(place) ? glm::vec3(to_world * glm::dvec3(vectorAt(gbuffer.position, place))) : glm::vec3(0);
  });
  const Plane depth = layRows<float>(gbuffer, frame, wanted.depth, 1, [&](std::size_t place) {
    return glm::vec1(-gbuffer.position[place + 2 * n]);
  });
  const Plane normal = layRows<float>(gbuffer, frame, wanted.normal, 3, [&](std::size_t place) {
    return glm::vec3(to_world * glm::dvec3(vectorAt(gbuffer.normal, place)));
  });
  const auto idsOf = [&](bool names, const auto& plane) {
    return layRows<int>(gbuffer, frame, names, 1, [&](std::size_t place) {
      return glm::ivec1(!isSeen(place) ? -1 : plane.empty() ? 0 : int(plane[place]));
    });
  };
  const ModelPlane none;
  const auto object = idsOf(wanted.object, none), material = idsOf(wanted.material, none);
  Plane after(3 * std::size_t(frame.plane_stride));
  const auto orNone = [&](const auto& plane) {
    return plane.empty() ? decltype(borrowed(device, plane)){} : borrowed(device, plane);
  };
  for (std::size_t i = 0; i < picture.plan.screens.size(); ++i) {
    const ScreenProgram& screen = picture.plan.screens[i];
    const Buffer<float> image = borrowedForOutput(device, after);
    const ScreenMarks marks = screenRows(device, screen,
                                         {frame, borrowed(device, before), orNone(from_eye), orNone(depth),
                                          orNone(normal), orNone(object), orNone(material), image});
    download(device, image, after);
    if (!marks.beyond.empty()) throw InputError(marks.beyond);
    addCount(picture.stats, fmt::format("screen_{}_bad_pixels", i + 1), marks.bad_colors);
    std::swap(before, after);
  }
  return {frame, std::move(before)};
}

void setScreenedColors(const ScreenedColors& sum, int samples, Image& image) {
  const ScreenFrame& frame = sum.frame;
  const float scale = 1 / float(samples);
  const std::size_t channels = image.channels.size();
  tbb::parallel_for(0, frame.rows, [&](int y) {
    const float* from = sum.color.data() + std::size_t(y) * std::size_t(frame.row_stride) + kScreenPad;
    float* pixel = image.pixels.data() + std::size_t(y) * std::size_t(frame.columns) * channels;
    for (int x = 0; x < frame.columns; ++x, pixel += channels)
      for (std::size_t c = 0; c < 3; ++c)
        pixel[c] = finiteColor(from[std::size_t(x) + c * frame.plane_stride] * scale);
  });
}

}  // namespace luciole
