#include "render/screens.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>
#include <vector>

#include "kernels/shared.h"
#include "lighting/count_picture.hpp"
#include "luciole/error.hpp"
#include "raster/square.hpp"
#include "render/assemble.hpp"

namespace luciole {
namespace {

ScreenFrame frameOf(const GBuffer& gbuffer, const PixelRectangle& inner) {
  const Camera& camera = gbuffer.camera;
  const int row = (gbuffer.width + kScreenPad - 1) / kScreenPad * kScreenPad + 2 * kScreenPad;
  const glm::vec3 eye(camera.camera_to_world[3]), back(glm::normalize(camera.camera_to_world[2]));
  const double pixel = 2 * camera.pixel_aspect *
                       (camera.orthographic ? camera.half_height : std::tan(camera.fov_y / 2)) /
                       gbuffer.picture_size.y;
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

/// The places in a square (kSquareLayout) of its pixels row by row.
constexpr std::array<std::array<int, kSquareSize>, kSquareSize> kSquareRows = [] {
  std::array<std::array<int, kSquareSize>, kSquareSize> rows{};
  for (int i = 0; i < kSquarePixels; ++i) rows[kSquareLayout.y[i]][kSquareLayout.x[i]] = i;
  return rows;
}();

/// Lays kCount planes in rows, which go on beyond their ends as they end. set(place, square): sets the
/// square's values from those at the place of its first pixel in the G-buffer.
template <std::size_t kCount, class T, class Set>
void layRows(const GBuffer& gbuffer, const ScreenFrame& frame, const Set& set, RawArray<T>& planes) {
  planes.resize(kCount * frame.plane_stride);
  tbb::parallel_for(0, (frame.rows + kSquareSize - 1) / kSquareSize, [&](int square_row) {
    const int first_row = square_row * kSquareSize, rows = std::min(kSquareSize, frame.rows - first_row);
    T* const out = planes.data() + std::size_t(first_row) * std::size_t(frame.row_stride) + kScreenPad;
    for (int x = 0; x < frame.columns; x += kSquareSize) {
      std::array<Lanes<T>, kCount> square;
      set(gbuffer.index(x, first_row), square);
      for (std::size_t c = 0; c < kCount; ++c)
        for (int y = 0; y < rows; ++y)
          for (int i = 0; i < kSquareSize; ++i)
            out[c * frame.plane_stride + std::size_t(y * frame.row_stride + x + i)] =
                square[c][kSquareRows[y][i]];
    }
    for (std::size_t c = 0; c < kCount; ++c)
      for (int y = 0; y < rows; ++y) {
        T *const first = out + c * frame.plane_stride + std::ptrdiff_t(y) * frame.row_stride,
                 *const end = first + frame.columns;
        std::fill(first - kScreenPad, first, *first);
        std::fill(end, first - kScreenPad + frame.row_stride, end[-1]);
      }
  });
}

/// The depths of a square's pixels that see nothing.
constexpr float kNothing = -std::numeric_limits<float>::infinity();

/// Vectors x y z of a G-buffer, turned to the world; 0 for pixels that see nothing.
void layVectors(const GBuffer& gbuffer, const ScreenFrame& frame, const Plane& vectors,
                RawArray<float>& planes) {
  const std::size_t n = gbuffer.pixels();
  const glm::dmat3 turn(gbuffer.camera.camera_to_world);
  layRows<3>(
      gbuffer, frame,
      [&](std::size_t place, std::array<Lanes<float>, 3>& square) {
        const float *x = vectors.data() + place, *y = x + n, *z = y + n,
                    *depth = gbuffer.position.data() + 2 * n + place;
        for (int i = 0; i < kSquarePixels; ++i)
          for (int c = 0; c < 3; ++c) {
            const double turned = turn[0][c] * x[i] + turn[1][c] * y[i] + turn[2][c] * z[i];
            square[std::size_t(c)][i] = depth[i] > kNothing ? float(turned) : 0.0f;
          }
      },
      planes);
}

/// Colours with exposure.
void layColors(const GBuffer& gbuffer, const ScreenFrame& frame, const Plane& color, float exposure,
               RawArray<float>& planes) {
  const std::size_t n = gbuffer.pixels();
  layRows<3>(
      gbuffer, frame,
      [&](std::size_t place, std::array<Lanes<float>, 3>& square) {
        for (std::size_t c = 0; c < 3; ++c)
          for (int i = 0; i < kSquarePixels; ++i)
            square[c][i] = finiteColor(color[place + c * n + std::size_t(i)] * exposure);
      },
      planes);
}

void layDepths(const GBuffer& gbuffer, const ScreenFrame& frame, RawArray<float>& planes) {
  const float* const z = gbuffer.position.data() + 2 * gbuffer.pixels();
  layRows<1>(
      gbuffer, frame,
      [&](std::size_t place, std::array<Lanes<float>, 1>& square) {
        for (int i = 0; i < kSquarePixels; ++i) square[0][i] = -z[place + std::size_t(i)];
      },
      planes);
}

/// Numbers in the scene; 0 where the G-buffer has none, -1 for pixels that see nothing.
void layIds(const GBuffer& gbuffer, const ScreenFrame& frame, const IndexPlane& ids, RawArray<int>& planes) {
  const float* const z = gbuffer.position.data() + 2 * gbuffer.pixels();
  layRows<1>(
      gbuffer, frame,
      [&](std::size_t place, std::array<Lanes<int>, 1>& square) {
        for (std::size_t i = 0; i < kSquarePixels; ++i)
          square[0][i] = !(z[place + i] > kNothing) ? -1 : ids.empty() ? 0 : int(ids[place + i]);
      },
      planes);
}

}  // namespace

ScreenGroups groupsOf(const std::vector<ScreenProgram>& screens) {
  ScreenGroups groups;
  for (const ScreenProgram& screen : screens) {
    const auto names = [&](std::string_view name) {
      return screen.shader.text.find(name) != std::string::npos;
    };
    groups.from_eye |= names("position_at") || names("from_eye_at") || names("to_eye_at");
    groups.depth |= names("depth_at") || names("pixel_size_at");
    groups.normal |= names("normal_at");
    groups.object |= names("object_at");
    groups.material |= names("material_at");
  }
  return groups;
}

std::size_t screenFloats(const std::vector<ScreenProgram>& screens, int samples) {
  if (screens.empty()) return 0;
  const ScreenGroups groups = groupsOf(screens);
  return 6 + (samples > 1 ? 3 : 0) + (groups.from_eye ? 3 : 0) + (groups.depth ? 1 : 0) +
         (groups.normal ? 3 : 0) + (groups.object ? 1 : 0) + (groups.material ? 1 : 0);
}

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
  const ScreenGroups wanted = groupsOf(picture.plan.screens);
  const ScreenFrame frame = frameOf(gbuffer, inner);
  ScreenMemory& planes = picture.recycled.screens;
  layColors(gbuffer, frame, color, std::exp2(picture.settings.exposure), planes.before);
  planes.after.resize(planes.before.size());
  if (wanted.from_eye) layVectors(gbuffer, frame, gbuffer.position, planes.from_eye);
  if (wanted.depth) layDepths(gbuffer, frame, planes.depth);
  if (wanted.normal) layVectors(gbuffer, frame, gbuffer.normal, planes.normal);
  if (wanted.object) layIds(gbuffer, frame, gbuffer.object, planes.object);
  if (wanted.material) layIds(gbuffer, frame, gbuffer.material, planes.material);
  const auto orNone = [&](bool is_wanted, const auto& plane) {
    return is_wanted ? borrowed(device, plane) : decltype(borrowed(device, plane)){};
  };
  for (std::size_t i = 0; i < picture.plan.screens.size(); ++i) {
    const ScreenProgram& screen = picture.plan.screens[i];
    const Buffer<float> image = borrowedForOutput(device, planes.after);
    const ScreenMarks marks = screenRows(device, screen,
                                         {.frame = frame,
                                          .color = borrowed(device, planes.before),
                                          .from_eye = orNone(wanted.from_eye, planes.from_eye),
                                          .depth = orNone(wanted.depth, planes.depth),
                                          .normal = orNone(wanted.normal, planes.normal),
                                          .object = orNone(wanted.object, planes.object),
                                          .material = orNone(wanted.material, planes.material),
                                          .image = image});
    download(device, image, planes.after);
    if (!marks.beyond.empty()) throw InputError(marks.beyond);
    if (marks.bad_colors > 0) addCount(picture.stats, faultyScreenPixels(i), marks.bad_colors);
    std::swap(planes.before, planes.after);
  }
  return {frame, std::move(planes.before)};
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
