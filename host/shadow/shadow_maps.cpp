#include "shadow/shadow_maps.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/matrix_access.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <numeric>

#include "error.hpp"
#include "raster/rasterize.hpp"
#include "scene/load_scene.hpp"

namespace luciole {
namespace {

constexpr int kSmallestSize = 16;  ///< texels a side

/// Texels around a perspective map's cone or a cube's face that filtered lookups may touch.
constexpr double kBorder = 4.0;

/// Nearest occluder of a light with a place, as a share of its reach.
constexpr double kNearShare = 5e-4;

/// Metres; in place of 0, where all of a scene is one point. Files may have lengths from here on.
constexpr double kSmallestLength = 1e-18;

constexpr double kWidestSpot = 60.0 * 3.14159265358979323846 / 180.0;

using Polygon = std::vector<glm::dvec3>;

/// The part of a convex polygon where dot(plane, (p, 1)) ≥ 0 (Sutherland & Hodgman 1974).
Polygon clipPolygon(const Polygon& polygon, const glm::dvec4& plane) {
  Polygon kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const glm::dvec3 a = polygon[i], b = polygon[(i + 1) % polygon.size()];
    const double da = glm::dot(plane, glm::dvec4(a, 1)), db = glm::dot(plane, glm::dvec4(b, 1));
    if (da >= 0) kept.push_back(a);
    if ((da >= 0) != (db >= 0)) kept.push_back(a + (b - a) * (da / (da - db)));
  }
  return kept;
}

/// Corner i of a hexahedron has bit 0: x, bit 1: y, bit 2: z at its high side.
using Corners = std::array<glm::dvec3, 8>;
constexpr std::array<std::array<int, 4>, 6> kFaces{
    {{0, 2, 6, 4}, {1, 5, 7, 3}, {0, 4, 5, 1}, {2, 3, 7, 6}, {0, 1, 3, 2}, {4, 6, 7, 5}}};

/// The planes of a hexahedron's faces, inside where positive.
std::array<glm::dvec4, 6> facePlanes(const Corners& corners) {
  const glm::dvec3 middle = std::accumulate(corners.begin(), corners.end(), glm::dvec3(0)) / 8.0;
  std::array<glm::dvec4, 6> planes;
  for (std::size_t i = 0; i < 6; ++i) {
    const auto& face = kFaces[i];
    const glm::dvec3 normal =
        glm::cross(corners[face[1]] - corners[face[0]], corners[face[3]] - corners[face[0]]);
    const glm::dvec4 plane(normal, -glm::dot(normal, corners[face[0]]));
    planes[i] = glm::dot(plane, glm::dvec4(middle, 1)) < 0 ? -plane : plane;
  }
  return planes;
}

void appendClippedFaces(const Corners& of, const Corners& by, std::vector<glm::dvec3>& points) {
  const auto planes = facePlanes(by);
  for (const auto& face : kFaces) {
    Polygon polygon;
    for (const int corner : face) polygon.push_back(of[corner]);
    for (const glm::dvec4& plane : planes) polygon = clipPolygon(polygon, plane);
    points.insert(points.end(), polygon.begin(), polygon.end());
  }
}

Corners boxCorners(const Bounds& box) {
  Corners corners;
  for (int i = 0; i < 8; ++i)
    corners[i] = {(i & 1 ? box.high : box.low).x, (i & 2 ? box.high : box.low).y,
                  (i & 4 ? box.high : box.low).z};
  return corners;
}

/// World-space corners of what a view can see.
Corners viewCorners(const View& view) {
  const glm::dmat4 clip_to_world = glm::inverse(view.projection * view.world_to_view);
  Corners corners;
  for (int i = 0; i < 8; ++i) {
    const glm::dvec4 p = clip_to_world * glm::dvec4(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : 0, 1);
    corners[i] = glm::dvec3(p) / p.w;
  }
  return corners;
}

/// Some rigid view from `eye` along `forward`, with `up` upwards where it can be.
glm::dmat4 lookAlong(const glm::dvec3& eye, const glm::dvec3& forward, glm::dvec3 up) {
  if (glm::length(glm::cross(forward, up)) < 1e-3)
    up = std::abs(forward.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, 1);
  return glm::lookAt(eye, eye + forward, up);
}

float4 toFloat4(const glm::dvec4& v) { return {float(v.x), float(v.y), float(v.z), float(v.w)}; }

/// A map on its way: where it is drawn from, and how it is looked up.
struct PlannedMap {
  ShadowMap lookup{};
  std::vector<View> faces;
  std::vector<std::uint32_t> casters;  ///< objects that can cast into it
};

/// Texel rows of a planar map, for positions in the space that `to_clip` starts from.
void setPlanarRows(const glm::dmat4& to_clip, int size, ShadowMap& map) {
  const glm::dvec4 x = glm::row(to_clip, 0), y = glm::row(to_clip, 1), w = glm::row(to_clip, 3);
  map.to_map_x = toFloat4((w + x) * (0.5 * size));
  map.to_map_y = toFloat4((w - y) * (0.5 * size));
  map.to_map_z = toFloat4(glm::row(to_clip, 2));
  map.to_map_w = toFloat4(w);
}

View squareView(const glm::dmat4& world_to_view, const glm::dmat4& projection, int size) {
  View view;
  view.world_to_view = world_to_view;
  view.projection = projection;
  view.size = view.crop_size = glm::ivec2(size);
  return view;
}

PlannedMap planParallel(const Light& light, const View& camera_view, const Bounds& scene, int size) {
  const Corners box = boxCorners(scene), seen = viewCorners(camera_view);
  std::vector<glm::dvec3> points;
  appendClippedFaces(seen, box, points);
  appendClippedFaces(box, seen, points);
  if (points.empty()) points.assign(box.begin(), box.end());  // nothing to see: any map will do

  // Aligned with the way the camera looks, which a perspective view's long side follows.
  const glm::dvec3 ahead = -glm::dvec3(glm::row(camera_view.world_to_view, 2));
  const glm::dmat4 world_to_light = lookAlong(glm::dvec3(0), light.direction, ahead);
  glm::dvec3 low(1e300), high(-1e300);
  for (const glm::dvec3& point : points) {
    const glm::dvec3 p(world_to_light * glm::dvec4(point, 1));
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  for (const glm::dvec3& corner : box)  // everything between what is seen and the light casts
    high.z = std::max(high.z, (world_to_light * glm::dvec4(corner, 1)).z);

  // Room for the lookup's reach at the rim, and for scenes that are flat in some direction: more than what
  // doubles lose far from the origin, 2⁻⁵³ of the distance in each of some ten operations.
  const double least =
      std::max({kSmallestLength, 1e-6 * glm::length(scene.high - scene.low), 1e-14 * glm::length(high)});
  const glm::dvec3 margin = glm::max((high - low) * (kBorder / size), glm::dvec3(least));
  low -= margin;
  high += margin;
  PlannedMap planned;
  const glm::dmat4 projection = orthographicProjection(low.x, high.x, low.y, high.y, -high.z, -low.z);
  planned.faces.push_back(squareView(world_to_light, projection, size));
  setPlanarRows(projection * world_to_light * glm::inverse(camera_view.world_to_view), size, planned.lookup);
  planned.lookup.kind = kParallelMap;
  planned.lookup.texel = float(std::max(high.x - low.x, high.y - low.y) / size);
  return planned;
}

/// Distance that a light with a place can cast shadows over: its range, or to the scene's farthest corner.
double lightReach(const Light& light, const Bounds& scene) {
  if (std::isfinite(light.range)) return light.range;
  double reach = kSmallestLength;
  for (const glm::dvec3& corner : boxCorners(scene))
    reach = std::max(reach, glm::distance(corner, light.position));
  return reach * 1.001;
}

void setPerspectiveDepth(const glm::dmat4& projection, ShadowMap& map) {
  map.depth_scale = float(projection[3][2]);
  map.depth_offset = float(-projection[2][2]);
}

PlannedMap planPerspective(const Light& light, const View& camera_view, const Bounds& scene, int size) {
  const double reach = lightReach(light, scene);
  const double half = 0.5 * size;
  const double tangent = std::tan(std::max(light.cutoff, 1e-3)) * half / (half - kBorder);
  const glm::dmat4 projection = perspectiveProjection(2 * std::atan(tangent), 1.0, reach * kNearShare, reach);
  const glm::dmat4 world_to_light = lookAlong(light.position, light.direction, glm::dvec3(0, 1, 0));
  PlannedMap planned;
  planned.faces.push_back(squareView(world_to_light, projection, size));
  setPlanarRows(projection * world_to_light * glm::inverse(camera_view.world_to_view), size, planned.lookup);
  setPerspectiveDepth(projection, planned.lookup);
  planned.lookup.kind = kPerspectiveMap;
  planned.lookup.texel = float(tangent / half);
  return planned;
}

PlannedMap planCube(const Light& light, const View& camera_view, const Bounds& scene, int size) {
  const double reach = lightReach(light, scene);
  const double half = 0.5 * size, face_scale = half - kBorder;
  const glm::dmat4 projection =
      perspectiveProjection(2 * std::atan(half / face_scale), 1.0, reach * kNearShare, reach);
  PlannedMap planned;
  for (int face = 0; face < 6; ++face) {
    // Right, up and backward axes as cube_point() in kernels/shadow.clh has them.
    const int axis = face / 2;
    const double sign = face % 2 ? -1.0 : 1.0;
    glm::dvec3 right(0), up(0), backward(0);
    right[(axis + 2) % 3] = sign;
    up[(axis + 1) % 3] = 1;
    backward[axis] = -sign;
    const glm::dmat4 light_to_world(glm::dvec4(right, 0), glm::dvec4(up, 0), glm::dvec4(backward, 0),
                                    glm::dvec4(light.position, 1));
    planned.faces.push_back(squareView(glm::inverse(light_to_world), projection, size));
  }
  const glm::dmat4 view_to_way =
      glm::translate(glm::dmat4(1), -light.position) * glm::inverse(camera_view.world_to_view);
  planned.lookup.to_map_x = toFloat4(glm::row(view_to_way, 0));
  planned.lookup.to_map_y = toFloat4(glm::row(view_to_way, 1));
  planned.lookup.to_map_z = toFloat4(glm::row(view_to_way, 2));
  setPerspectiveDepth(projection, planned.lookup);
  planned.lookup.kind = kCubeMap;
  planned.lookup.texel = float(1.0 / face_scale);
  planned.lookup.face_scale = float(face_scale);
  return planned;
}

/// The objects within reach of a light.
std::vector<std::uint32_t> findCasters(const Light& light, const std::vector<Bounds>& objects, double reach) {
  std::vector<std::uint32_t> casters;
  for (std::uint32_t i = 0; i < objects.size(); ++i) {
    const glm::dvec3 nearest = glm::clamp(light.position, objects[i].low, objects[i].high);
    if (light.kind == LightKind::kDirectional || glm::distance(nearest, light.position) <= reach)
      casters.push_back(i);
  }
  return casters;
}

/// Texels a side of a light's map where a directional light has `size`.
int mapSize(const Light& light, int size) {
  const int divisor = light.kind == LightKind::kDirectional ? 1 : usesCubeMap(light) ? 4 : 2;
  return std::max(size / divisor, kSmallestSize);
}

}  // namespace

bool usesCubeMap(const Light& light) {
  return light.kind == LightKind::kPoint || (light.kind == LightKind::kSpot && light.cutoff > kWidestSpot);
}

ShadowMaps drawShadowMaps(const Scene& scene, const View& camera_view, int size) {
  ShadowMaps result;
  result.map_of_light.assign(scene.lights.size(), kNoShadow);
  std::vector<Bounds> object_bounds;
  Bounds bounds;
  for (const Object& object : scene.objects) {
    object_bounds.push_back(objectBounds(scene, object));
    bounds.low = glm::min(bounds.low, object_bounds.back().low);
    bounds.high = glm::max(bounds.high, object_bounds.back().high);
  }
  if (bounds.low.x > bounds.high.x) return result;

  const auto totalDepths = [&] {
    std::size_t total = 0;
    for (const Light& light : scene.lights) {
      const std::size_t side = mapSize(light, size);
      if (light.shadow) total += side * side * (usesCubeMap(light) ? 6 : 1);
    }
    return total;
  };
  while (totalDepths() * sizeof(float) > kShadowBudget) {
    if (size <= kSmallestSize)
      throw MachineError(fmt::format("{}: the shadow maps of its lights don't fit into {} MiB", scene.name,
                                     kShadowBudget >> 20));
    size /= 2;
  }

  std::vector<PlannedMap> planned;
  std::size_t offset = 0;
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    const Light& light = scene.lights[i];
    if (!light.shadow) continue;
    const int side = mapSize(light, size);
    PlannedMap map = usesCubeMap(light) ? planCube(light, camera_view, bounds, side)
                     : light.kind == LightKind::kDirectional
                         ? planParallel(light, camera_view, bounds, side)
                         : planPerspective(light, camera_view, bounds, side);
    map.casters = findCasters(light, object_bounds, lightReach(light, bounds));
    map.lookup.offset = static_cast<uint>(offset);
    map.lookup.size = static_cast<uint>(side);
    offset += std::size_t(side) * side * map.faces.size();
    result.map_of_light[i] = static_cast<std::uint32_t>(planned.size());
    planned.push_back(std::move(map));
  }

  result.depths.resize(offset);
  for (const PlannedMap& map : planned) {
    const std::size_t face_depths = std::size_t(map.lookup.size) * map.lookup.size;
    tbb::parallel_for(std::size_t(0), map.faces.size(), [&](std::size_t face) {
      const DepthMap drawn = rasterizeDepth(scene, map.casters, map.faces[face]);
      std::copy(drawn.depth.begin(), drawn.depth.end(),
                result.depths.begin() + map.lookup.offset + face * face_depths);
    });
    result.maps.push_back(map.lookup);
  }
  return result;
}

}  // namespace luciole
