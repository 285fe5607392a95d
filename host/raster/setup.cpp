#include "raster/setup.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "raster/clip.hpp"

namespace luciole {
namespace {

/// Which way round a triangle must go on the picture, y down; the other way it is only there by rounding.
enum class Winding : std::uint8_t { kAny, kClockwise, kCounterClockwise };

/// What a run of triangles adds to.
struct Output {
  std::vector<RasterTriangle> triangles;
  std::uint64_t back_facing = 0;
};

/// What holds for all triangles.
struct Frame {
  const View& view;
  ClipVolume volume;
  glm::dvec2 snap_low;  ///< 1/256 pixel: the guard band
  glm::dvec2 snap_high;
};

Frame makeFrame(const View& view) {
  const glm::dvec2 middle = double(kSubpixels) * (0.5 * glm::dvec2(view.size) - view.sample);
  const double reach = double(kGuardPixels) * kSubpixels;
  return {view, clipVolume(view), middle - reach, middle + reach};
}

/// A depth plane through the corners before snapping, which is as exact as they are. Where the triangle is
/// seen edge on no plane is finite, and the nearest corner's depth stands for all.
void setDepthPlane(const ScreenVertex& a, const ScreenVertex& b, const ScreenVertex& c, RasterTriangle& out) {
  const auto [low, high] = std::minmax({a.depth, b.depth, c.depth});
  out.depth_low = float(low);
  out.depth_high = float(high);
  const glm::dvec3 ab(b.x - a.x, b.y - a.y, b.depth - a.depth);
  const glm::dvec3 ac(c.x - a.x, c.y - a.y, c.depth - a.depth);
  const double inverse_area = 1.0 / (ab.x * ac.y - ab.y * ac.x);
  out.depth_dx = (ab.z * ac.y - ab.y * ac.z) * inverse_area;
  out.depth_dy = (ab.x * ac.z - ab.z * ac.x) * inverse_area;
  // Beyond this a step across 16 pixels would leave the floats.
  constexpr double kSteepest = 1e30;
  if (!(std::abs(out.depth_dx) < kSteepest && std::abs(out.depth_dy) < kSteepest)) {
    out.depth_dx = out.depth_dy = 0.0;
    out.depth = high;
    return;
  }
  out.depth = a.depth - out.depth_dx * a.x - out.depth_dy * a.y;
}

void emitTriangle(const std::array<ScreenVertex, 3>& corners, const Frame& frame, Winding winding,
                  std::uint32_t number, bool masked, Output& output) {
  RasterTriangle triangle;
  for (int i = 0; i < 3; ++i) {
    const double x = corners[i].x * kSubpixels;
    const double y = corners[i].y * kSubpixels;
    if (!(std::isfinite(x) && std::isfinite(y))) return;
    triangle.x[i] = std::int32_t(std::lrint(std::clamp(x, frame.snap_low.x, frame.snap_high.x)));
    triangle.y[i] = std::int32_t(std::lrint(std::clamp(y, frame.snap_low.y, frame.snap_high.y)));
  }
  const PixelBox box = pixelBox(triangle);
  const glm::ivec2 crop_last = frame.view.crop_origin + frame.view.crop_size - 1;
  const glm::ivec2 first = glm::max(box.first, frame.view.crop_origin);
  const glm::ivec2 last = glm::min(box.last, crop_last);
  if (first.x > last.x || first.y > last.y) return;

  const std::int64_t area = std::int64_t(triangle.x[1] - triangle.x[0]) * (triangle.y[2] - triangle.y[0]) -
                            std::int64_t(triangle.y[1] - triangle.y[0]) * (triangle.x[2] - triangle.x[0]);
  // A triangle that snapping turned over is dropped: its neighbours overlap where it lies.
  if (area == 0 || (area < 0 && winding == Winding::kClockwise) ||
      (area > 0 && winding == Winding::kCounterClockwise))
    return;
  if (area < 0) {
    std::swap(triangle.x[1], triangle.x[2]);
    std::swap(triangle.y[1], triangle.y[2]);
  }
  setDepthPlane(corners[0], corners[1], corners[2], triangle);
  triangle.triangle = number;
  triangle.masked = masked;
  output.triangles.push_back(triangle);
}

void setupTriangle(const Scene& scene, const Geometry& geometry, const PlacedObject& object,
                   std::uint32_t in_mesh, const Frame& frame, FaceCulling culling, Output& output) {
  const glm::uvec3 corners = object.mesh->triangles[in_mesh];
  const std::array<std::size_t, 3> vertices{
      object.first_vertex + corners[0], object.first_vertex + corners[1], object.first_vertex + corners[2]};
  const auto place = [&](int i) { return geometry.places[vertices[i]]; };
  const unsigned any = place(0) | place(1) | place(2);
  if ((any & kUnusable) || (place(0) & place(1) & place(2) & kOutsideVolume)) return;

  const Material& material = materialOf(scene, object, in_mesh);
  Winding winding = Winding::kAny;
  if (culling == FaceCulling::kBackFaces) {
    const glm::dvec3& a = geometry.positions[vertices[0]];
    const glm::dvec3 normal =
        glm::cross(geometry.positions[vertices[1]] - a, geometry.positions[vertices[2]] - a);
    const bool counter_clockwise = eyeInFront(normal, a, isPerspective(frame.view));
    if (counter_clockwise == object.mirrored && !material.double_sided) {
      ++output.back_facing;
      return;
    }
    winding = counter_clockwise ? Winding::kCounterClockwise : Winding::kClockwise;
  }

  const std::uint32_t number = object.first_triangle + in_mesh;
  const bool masked = material.alpha_cutoff > 0.0f;
  if (!(any & (kBehindNear | kBeyondFar | kOutsideGuard))) {
    emitTriangle({geometry.screen[vertices[0]], geometry.screen[vertices[1]], geometry.screen[vertices[2]]},
                 frame, winding, number, masked, output);
    return;
  }
  const auto clip = [&](int i) {
    return frame.view.projection * glm::dvec4(geometry.positions[vertices[i]], 1.0);
  };
  const ClipPolygon polygon = clipTriangle({clip(0), clip(1), clip(2)}, frame.volume);
  for (int i = 2; i < polygon.count; ++i)
    emitTriangle({toScreen(polygon.corners[0], frame.view), toScreen(polygon.corners[i - 1], frame.view),
                  toScreen(polygon.corners[i], frame.view)},
                 frame, winding, number, masked, output);
}

}  // namespace

RasterSetup setupTriangles(const Scene& scene, const Geometry& geometry, const View& view,
                           FaceCulling culling) {
  const Frame frame = makeFrame(view);
  constexpr std::uint32_t kRun = 2048;  // triangles a task; the runs' outputs are joined in order
  const std::size_t runs = (std::size_t(geometry.triangle_count) + kRun - 1) / kRun;
  std::vector<Output> outputs(runs);
  tbb::parallel_for(std::size_t(0), runs, [&](std::size_t run) {
    outputs[run].triangles.reserve(kRun);
    std::uint32_t number = std::uint32_t(run * kRun);
    const std::uint32_t end = std::uint32_t(std::min<std::size_t>(geometry.triangle_count, (run + 1) * kRun));
    const PlacedObject* object = &objectOfTriangle(geometry.objects, number);
    for (; number < end; ++object) {
      const std::size_t object_end = std::size_t(object->first_triangle) + object->mesh->triangles.size();
      for (; number < end && number < object_end; ++number)
        setupTriangle(scene, geometry, *object, number - object->first_triangle, frame, culling,
                      outputs[run]);
    }
  });

  RasterSetup setup;
  std::vector<std::size_t> starts(runs);
  std::size_t total = 0;
  for (std::size_t run = 0; run < runs; ++run) {
    starts[run] = total;
    total += outputs[run].triangles.size();
    setup.back_facing += outputs[run].back_facing;
  }
  setup.triangles.resize(total);
  tbb::parallel_for(std::size_t(0), runs, [&](std::size_t run) {
    std::copy(outputs[run].triangles.begin(), outputs[run].triangles.end(),
              setup.triangles.begin() + starts[run]);
  });
  return setup;
}

}  // namespace luciole
