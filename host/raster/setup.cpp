#include "raster/setup.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <utility>

#include "raster/clip.hpp"
#include "raster/concatenate.hpp"
#include "raster/opacity.hpp"
#include "raster/rasterize.hpp"

namespace luciole {
namespace {

/// The winding that a triangle must have on the picture, y down. A triangle that snapping has turned over is
/// dropped.
enum class Winding : std::uint8_t { kAny, kClockwise, kCounterClockwise };

/// The output of a task of the setup.
struct Output {
  RasterTriangles& triangles;
  std::uint64_t back_facing = 0;
};

/// The parameters of a view for all triangles.
struct Frame {
  const View& view;
  ClipVolume volume;
  glm::dvec2 snap_low;  ///< the guard band, 1/256 pixel
  glm::dvec2 snap_high;
};

Frame makeFrame(const View& view) {
  const glm::dvec2 middle = double(kSubpixels) * (0.5 * glm::dvec2(view.size) - view.sample);
  const double reach = double(kGuardPixels) * kSubpixels;
  return {view, clipVolume(view), middle - reach, middle + reach};
}

/// Sets the depth plane through the corners before snapping, so that snapping doesn't tilt it. A triangle
/// seen edge on has no finite plane: it takes the depth of its nearest corner.
void setDepthPlane(const ScreenVertex& a, const ScreenVertex& b, const ScreenVertex& c, RasterTriangle& out) {
  const auto [low, high] = std::minmax({a.depth, b.depth, c.depth});
  out.depth_low = float(low);
  out.depth_high = float(high);
  const glm::dvec3 ab(b.x - a.x, b.y - a.y, b.depth - a.depth);
  const glm::dvec3 ac(c.x - a.x, c.y - a.y, c.depth - a.depth);
  const double inverse_area = 1.0 / (ab.x * ac.y - ab.y * ac.x);
  out.depth_dx = (ab.z * ac.y - ab.y * ac.z) * inverse_area;
  out.depth_dy = (ab.x * ac.z - ab.z * ac.x) * inverse_area;
  // With steeper planes 16 steps could overflow a float.
  constexpr double kSteepest = 1e30;
  if (!(std::abs(out.depth_dx) < kSteepest && std::abs(out.depth_dy) < kSteepest)) {
    out.depth_dx = out.depth_dy = 0.0;
    out.depth = high;
    return;
  }
  out.depth = a.depth - out.depth_dx * a.x - out.depth_dy * a.y;
}

/// Adds a triangle whose box reaches a sample of the crop. `snapped`: x and y are set.
void emitSnapped(const RasterTriangle& snapped, const std::array<ScreenVertex, 3>& corners, Winding winding,
                 std::uint32_t number, bool masked, Output& output) {
  const std::int32_t *x = snapped.x, *y = snapped.y;
  const std::int64_t area =
      std::int64_t(x[1] - x[0]) * (y[2] - y[0]) - std::int64_t(y[1] - y[0]) * (x[2] - x[0]);
  // A triangle that snapping turned over is dropped: its neighbours cover its place.
  if (area == 0 || (area < 0 && winding == Winding::kClockwise) ||
      (area > 0 && winding == Winding::kCounterClockwise))
    return;
  // Filled in where it stays: a copy would wait for all these stores.
  RasterTriangle& triangle = output.triangles.emplace_back();
  const int second = area < 0 ? 2 : 1, third = 3 - second;
  triangle.x[0] = x[0], triangle.x[1] = x[second], triangle.x[2] = x[third];
  triangle.y[0] = y[0], triangle.y[1] = y[second], triangle.y[2] = y[third];
  setDepthPlane(corners[0], corners[1], corners[2], triangle);
  triangle.triangle = number;
  triangle.masked = masked;
}

/// Rounds a place on the picture to 1/256 pixel, ties to even, and clamps it to the guard band. `fine`: in
/// 1/256 pixel, finite.
inline std::int32_t snap(double fine, double low, double high) {
  // Adding and subtracting this rounds a double below 2⁵¹ to an integer. Unlike std::lrint it is vectorized.
  constexpr double kRound = 0x1.8p52;
  return std::int32_t((std::min(std::max(fine, low), high) + kRound) - kRound);
}

void emitTriangle(const std::array<ScreenVertex, 3>& corners, const Frame& frame, Winding winding,
                  std::uint32_t number, bool masked, Output& output) {
  RasterTriangle triangle;
  for (int i = 0; i < 3; ++i) {
    const double x = corners[i].x * kSubpixels;
    const double y = corners[i].y * kSubpixels;
    if (!(std::isfinite(x) && std::isfinite(y))) return;
    triangle.x[i] = snap(x, frame.snap_low.x, frame.snap_high.x);
    triangle.y[i] = snap(y, frame.snap_low.y, frame.snap_high.y);
  }
  const PixelBox box = pixelBox(triangle, frame.view.reach);
  const glm::ivec2 crop_last = frame.view.crop_origin + frame.view.crop_size - 1;
  const glm::ivec2 first = glm::max(box.first, frame.view.crop_origin);
  const glm::ivec2 last = glm::min(box.last, crop_last);
  if (first.x > last.x || first.y > last.y) return;
  emitSnapped(triangle, corners, winding, number, masked, output);
}

/// Transformed vertices; three arrays with the same index.
struct Vertices {
  const glm::dvec3* positions;  ///< view space
  const ScreenVertex* screen;
  const std::uint16_t* places;  ///< VertexPlace bits
};

void setupTriangle(const Scene& scene, const PlacedObject& object, std::uint32_t in_mesh,
                   const Vertices& vertices, const glm::uvec3& corners, const Frame& frame,
                   FaceCulling culling, Output& output) {
  const auto place = [&](int i) { return vertices.places[corners[i]]; };
  const unsigned any = place(0) | place(1) | place(2);
  if ((any & kUnusable) || (place(0) & place(1) & place(2) & kOutsideVolume)) return;

  const Material& material = materialOf(scene, object, in_mesh);
  Winding winding = Winding::kAny;
  if (culling == FaceCulling::kBackFaces) {
    const glm::dvec3& a = vertices.positions[corners[0]];
    const glm::dvec3 normal =
        glm::cross(vertices.positions[corners[1]] - a, vertices.positions[corners[2]] - a);
    const bool counter_clockwise = eyeInFront(normal, a, isPerspective(frame.view));
    if (counter_clockwise == object.mirrored && !material.double_sided) {
      ++output.back_facing;
      return;
    }
    winding = counter_clockwise ? Winding::kCounterClockwise : Winding::kClockwise;
  }

  const std::uint32_t number = object.first_triangle + in_mesh;
  const bool masked = hasHoles(material);
  if (!(any & (kBehindNear | kBeyondFar | kOutsideGuard))) {
    emitTriangle({vertices.screen[corners[0]], vertices.screen[corners[1]], vertices.screen[corners[2]]},
                 frame, winding, number, masked, output);
    return;
  }
  const auto clip = [&](int i) {
    return frame.view.projection * glm::dvec4(vertices.positions[corners[i]], 1.0);
  };
  const ClipPolygon polygon = clipTriangle({clip(0), clip(1), clip(2)}, frame.volume);
  for (int i = 2; i < polygon.count; ++i)
    emitTriangle({toScreen(polygon.corners[0], frame.view), toScreen(polygon.corners[i - 1], frame.view),
                  toScreen(polygon.corners[i], frame.view)},
                 frame, winding, number, masked, output);
}

constexpr std::size_t kMeshletVertices = 3 * kMeshletTriangles;  ///< at most

/// A meshlet's vertices as a structure of arrays, so that loops over them are vectorized. The values are
/// those of transformObjects() and emitTriangle(), bit for bit.
struct RunVertices {
  template <class T>
  using Of = std::array<T, kMeshletVertices>;
  alignas(64) Of<double> view_x, view_y, view_z;  ///< view space
  alignas(64) Of<double> x, y, depth;             ///< as in ScreenVertex
  alignas(64) Of<std::int32_t> snapped_x, snapped_y;
  /// Column (low 16 bits) and row (high 16 bits) of the first sample at or to the right of the vertex, and at
  /// or below it. They count from the crop's corner and are clamped to 0 … the crop's size. So a triangle's
  /// box reaches no sample of the crop where all its corners have the same column, or all the same row.
  alignas(64) Of<std::uint32_t> samples;
  /// VertexPlace bits. Vertices without a finite place on the picture count as outside the guard band.
  alignas(64) Of<std::uint32_t> places;

  ScreenVertex screen(std::size_t i) const { return {x[i], y[i], depth[i]}; }
};

/// One row of a matrix times (x, y, z, 1), as GLM multiplies.
struct MatrixRow {
  double x, y, z, w;
  MatrixRow(const glm::dmat4& m, int row) : x(m[0][row]), y(m[1][row]), z(m[2][row]), w(m[3][row]) {}
  double times(double a, double b, double c) const { return (x * a + y * b) + (z * c + w); }
};

/// Transforms a meshlet's vertices. Returns the VertexPlace bits that any of them has.
std::uint32_t transformMeshlet(const Meshlets& meshlets, const Meshlet& meshlet, const PlacedObject& object,
                               const Frame& frame, RunVertices& out) {
  const std::size_t count = meshlet.vertex_count;
  alignas(64) std::array<float, kMeshletVertices> position_x, position_y, position_z;
  const std::uint32_t* indices = meshlets.vertices.data() + meshlet.first_vertex;
  const glm::vec3* positions = object.mesh->positions.data();
  for (std::size_t i = 0; i < count; ++i) {
    const glm::vec3& position = positions[indices[i]];
    position_x[i] = position.x;
    position_y[i] = position.y;
    position_z[i] = position.z;
  }
  const MatrixRow to_view_x(object.object_to_view, 0), to_view_y(object.object_to_view, 1),
      to_view_z(object.object_to_view, 2);
  for (std::size_t i = 0; i < count; ++i) {
    const double x = position_x[i], y = position_y[i], z = position_z[i];
    out.view_x[i] = to_view_x.times(x, y, z);
    out.view_y[i] = to_view_y.times(x, y, z);
    out.view_z[i] = to_view_z.times(x, y, z);
  }
  const View view = frame.view;  // a copy, so that the compiler knows that no store below changes it
  const MatrixRow to_x(view.projection, 0), to_y(view.projection, 1), to_z(view.projection, 2),
      to_w(view.projection, 3);
  const glm::dvec2 guard = frame.volume.guard, low = frame.snap_low, high = frame.snap_high;
  constexpr double kLargest = std::numeric_limits<double>::max();
  std::uint32_t all = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const glm::dvec3 seen(out.view_x[i], out.view_y[i], out.view_z[i]);
    const glm::dvec4 clip(to_x.times(seen.x, seen.y, seen.z), to_y.times(seen.x, seen.y, seen.z),
                          to_z.times(seen.x, seen.y, seen.z), to_w.times(seen.x, seen.y, seen.z));
    const ScreenVertex screen = toScreen(clip, view);
    out.x[i] = screen.x;
    out.y[i] = screen.y;
    out.depth[i] = screen.depth;
    const double fine_x = screen.x * kSubpixels, fine_y = screen.y * kSubpixels;
    const bool placed = (std::abs(fine_x) <= kLargest) & (std::abs(fine_y) <= kLargest);
    const std::uint32_t place = vertexPlace(seen, clip, guard, placed);
    out.places[i] = place;
    all |= place;
    const std::int32_t snapped_x = snap(placed ? fine_x : 0.0, low.x, high.x);
    const std::int32_t snapped_y = snap(placed ? fine_y : 0.0, low.y, high.y);
    out.snapped_x[i] = snapped_x;
    out.snapped_y[i] = snapped_y;
    constexpr std::int32_t kUp = kSubpixels - 1;
    const std::int32_t column = ((snapped_x + kUp) >> kSubpixelBits) - view.crop_origin.x;
    const std::int32_t row = ((snapped_y + kUp) >> kSubpixelBits) - view.crop_origin.y;
    out.samples[i] = std::uint32_t(std::min(std::max(column, 0), view.crop_size.x)) |
                     std::uint32_t(std::min(std::max(row, 0), view.crop_size.y)) << 16;
  }
  return all;
}

void setupMeshlet(const Scene& scene, const Meshlets& meshlets, std::uint32_t index,
                  const PlacedObject& object, const Frame& frame, Output& output) {
  const Meshlet& meshlet = meshlets.items[index];
  RunVertices vertices;
  constexpr std::uint32_t kUncommon = kBehindNear | kBeyondFar | kOutsideGuard | kUnusable;
  const std::uint32_t places = transformMeshlet(meshlets, meshlet, object, frame, vertices);

  // Most triangles are rejected here, by vectorized loops.
  const std::uint8_t* corners = meshlets.corners.data() + index * kMeshletVertices;
  const auto corner = [&](std::uint32_t triangle, int c) {
    return corners[c * kMeshletTriangles + triangle];
  };
  alignas(64) std::array<std::uint8_t, kMeshletTriangles>
      kept{};  // 1: to be drawn, 2: perhaps clipped before
  for (std::uint32_t i = 0; i < kMeshletTriangles; ++i) {
    const std::uint32_t a = vertices.samples[corner(i, 0)], b = vertices.samples[corner(i, 1)],
                        c = vertices.samples[corner(i, 2)];
    const std::uint32_t differ = (a ^ b) | (b ^ c);
    kept[i] = ((differ & 0xffff) != 0) & (differ >> 16 != 0);
  }
  if (places & kUncommon) {
    for (std::uint32_t i = 0; i < kMeshletTriangles; ++i) {
      const std::uint32_t a = vertices.places[corner(i, 0)], b = vertices.places[corner(i, 1)],
                          c = vertices.places[corner(i, 2)];
      const bool uncommon = (a | b | c) & kUncommon;
      const bool outside = ((a | b | c) & kUnusable) | (a & b & c & kOutsideVolume);
      kept[i] = outside ? 0 : uncommon ? 2 : kept[i];
    }
  }
  std::array<std::uint8_t, kMeshletTriangles> list;
  std::size_t length = 0;
  for (std::uint32_t i = 0; i < meshlet.count; ++i) {
    list[length] = std::uint8_t(i);
    length += kept[i] != 0;
  }

  for (std::size_t place = 0; place < length; ++place) {
    const std::uint32_t i = list[place];
    const std::array<std::size_t, 3> at{corner(i, 0), corner(i, 1), corner(i, 2)};
    const std::array<ScreenVertex, 3> screen{vertices.screen(at[0]), vertices.screen(at[1]),
                                             vertices.screen(at[2])};
    if (kept[i] == 1) {
      RasterTriangle triangle;
      for (int c = 0; c < 3; ++c) {
        triangle.x[c] = vertices.snapped_x[at[c]];
        triangle.y[c] = vertices.snapped_y[at[c]];
      }
      const bool masked = materialOf(scene, object, meshlet.first + i).alpha_cutoff > 0.0f;
      emitSnapped(triangle, screen, Winding::kAny, object.first_triangle + meshlet.first + i, masked, output);
      continue;
    }
    std::array<glm::dvec3, 3> positions;
    std::array<std::uint16_t, 3> own_places;
    for (int c = 0; c < 3; ++c) {
      positions[c] = {vertices.view_x[at[c]], vertices.view_y[at[c]], vertices.view_z[at[c]]};
      own_places[c] = std::uint16_t(vertices.places[at[c]]);
    }
    setupTriangle(scene, object, meshlet.first + i, {positions.data(), screen.data(), own_places.data()},
                  {0, 1, 2}, frame, FaceCulling::kNone, output);
  }
}

}  // namespace

RasterSetup setupTriangles(const Scene& scene, const Geometry& geometry, const View& view,
                           FaceCulling culling, RasterSetup recycled) {
  const Frame frame = makeFrame(view);
  constexpr std::uint32_t kTask = 2048;  // triangles; the tasks' outputs are joined in order
  static_assert(kTask % kRunTriangles == 0);
  RasterSetup setup = std::move(recycled);
  setup.parts.resize((std::size_t(geometry.triangle_count) + kTask - 1) / kTask);
  std::atomic<std::uint64_t> back_facing = 0;
  tbb::parallel_for(std::size_t(0), setup.parts.size(), [&](std::size_t task) {
    Output output{setup.parts[task]};
    output.triangles.clear();
    std::uint32_t number = std::uint32_t(task * kTask);
    const std::uint32_t end =
        std::uint32_t(std::min<std::size_t>(geometry.triangle_count, (task + 1) * kTask));
    const PlacedObject* object = &objectOfTriangle(geometry.objects, number);
    for (; number < end; ++object) {
      const Vertices vertices{geometry.positions.data() + object->first_vertex,
                              geometry.screen.data() + object->first_vertex,
                              geometry.places.data() + object->first_vertex};
      const std::uint32_t first = object->first_triangle;
      const std::uint32_t object_end =
          std::uint32_t(std::min<std::size_t>(end, first + object->mesh->triangles.size()));
      while (number < object_end) {
        const std::uint32_t run = (number - first) / kRunTriangles;
        const std::uint32_t run_end = std::min(object_end, first + (run + 1) * kRunTriangles);
        if (!geometry.seen[object->first_run + run]) number = run_end;
        for (; number < run_end; ++number)
          setupTriangle(scene, *object, number - first, vertices, object->mesh->triangles[number - first],
                        frame, culling, output);
      }
    }
    back_facing += output.back_facing;
  });
  setup.back_facing = back_facing;
  setup.triangles = concatenate(setup.parts, std::move(setup.triangles));
  return setup;
}

RasterSetup setupMeshlets(const Scene& scene, const PlacedMeshlets& placed, const View& view) {
  const Frame frame = makeFrame(view);
  constexpr std::size_t kTask = 512;  // meshlets; the faces of most lights' maps have fewer
  const std::span<const std::uint32_t> chosen = placed.chosen;
  RasterSetup setup;
  setup.parts.resize((chosen.size() + kTask - 1) / kTask);
  tbb::parallel_for(std::size_t(0), setup.parts.size(), [&](std::size_t task) {
    const std::size_t end = std::min(chosen.size(), (task + 1) * kTask);
    Output output{setup.parts[task]};
    for (std::size_t i = task * kTask; i < end; ++i)
      setupMeshlet(scene, placed.meshlets, chosen[i], placed.object(i), frame, output);
  });
  if (setup.parts.size() == 1)
    setup.triangles = std::move(setup.parts[0]);
  else
    setup.triangles = concatenate(setup.parts);
  return setup;
}

void setCounts(std::uint32_t triangle_count, const RasterSetup& setup, RasterCounts& counts) {
  counts.submitted = triangle_count;
  counts.back_facing = setup.back_facing;
  counts.outside = counts.submitted - counts.back_facing -
                   std::uint64_t(std::count(counts.covering.begin(), counts.covering.end(), 1));
}

}  // namespace luciole
