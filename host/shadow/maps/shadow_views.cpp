#include "shadow/maps/shadow_views.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_access.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "shadow/maps/cascades.hpp"
#include "shadow/maps/frustum.hpp"

namespace luciole {
namespace {

/// The near plane of a light with a position, as a share of its reach.
constexpr double kNearShare = 5e-4;

/// Radians: the largest half angle of a cone that one perspective map shows.
constexpr double kWidestSpot = 60.0 * 3.14159265358979323846 / 180.0;

/// A rigid view from `eye` along `forward` (unit). Where `up` is parallel to it, another axis is up.
glm::dmat4 lookAlong(const glm::dvec3& eye, const glm::dvec3& forward, glm::dvec3 up) {
  if (glm::length(glm::cross(forward, up)) < 1e-3)
    up = std::abs(forward.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, 1);
  return glm::lookAt(eye, eye + forward, up);
}

float4 toFloat4(const glm::dvec4& v) { return {float(v.x), float(v.y), float(v.z), float(v.w)}; }

/// A row of a matrix that takes view-space points.
float4 rowOf(const glm::dmat4& m, int row) { return toFloat4(glm::row(m, row)); }

View squareView(const glm::dmat4& world_to_view, const glm::dmat4& projection, int size) {
  View view;
  view.world_to_view = world_to_view;
  view.projection = projection;
  view.size = view.crop_size = glm::ivec2(size);
  return view;
}

/// The distance in texels from the texel of a lookup to those that it may read, on a face with this border.
/// It is at least 1, because rounding may select the next texel.
int lookupRadius(int border, ShadowMethod method) {
  return method == ShadowMethod::kPcf || method == ShadowMethod::kSoft ? border : 1;
}

/// A face without texels.
ShadowFace emptyFace(double scale, const glm::dvec2& middle, int size, int border) {
  ShadowFace face{};
  face.scale = float(scale);
  face.middle_x = float(middle.x);
  face.middle_y = float(middle.y);
  face.low = float(border);
  face.high = float(size - border);
  return face;
}

PlannedMap planParallel(const Light& light, const PlanInput& input, int size) {
  // The axes depend on the light alone, so that texels stay where they are while the camera turns.
  const glm::dmat4 world_to_light = lookAlong(glm::dvec3(0), light.direction, glm::dvec3(0, 1, 0));
  double low = 1e300, high = -1e300;  // depths of all that is seen, and of all casters in front of it
  for (const glm::dvec3& corner : boxCorners(input.bounds)) {
    const double towards = (world_to_light * glm::dvec4(corner, 1)).z;
    low = std::min(low, towards);
    high = std::max(high, towards);
  }
  const glm::dvec3 eye(world_to_light * input.view_to_world[3]);
  const glm::dmat4 rotation = world_to_light * glm::dmat4(glm::dmat3(input.view_to_world));
  // A flat scene gets some depth: more than the rounding of doubles far from the origin, which is 2⁻⁵³ of the
  // distance in each of some ten operations.
  const double across = glm::distance(input.bounds.low, input.bounds.high);
  const double least =
      std::max({kSmallestLength, 1e-6 * across,
                1e-14 * std::max(glm::length(input.bounds.low), glm::length(input.bounds.high))});
  low -= least;
  high += least;

  PlannedMap planned;
  const int border = borderOf(size, input.method);
  // Even the widest penumbra must fit into the border.
  const double least_texel =
      input.method == ShadowMethod::kSoft ? std::tan(light.half_angle) * (high - low) / (border - 2) : 0;
  for (const Sphere& sphere : cascadeSpheres(input.camera, input.bounds)) {
    const double texel = std::max(2 * std::max(sphere.radius, least) / (size - 2 * border - 1), least_texel);
    if (!planned.faces.empty() && texel <= 1 / double(planned.faces.back().scale)) continue;
    const glm::dvec3 middle(world_to_light * glm::dvec4(sphere.middle, 1));
    const double left = (std::floor(middle.x / texel) - 0.5 * size) * texel;
    const double top = (std::floor(middle.y / texel) + 0.5 * size) * texel;
    const glm::dmat4 projection =
        orthographicProjection(left, left + size * texel, top - size * texel, top, -high, -low);
    planned.views.push_back(squareView(world_to_light, projection, size));
    planned.faces.push_back(
        emptyFace(1 / texel, {(eye.x - left) / texel, (top - eye.y) / texel}, size, border));
  }
  const double depth_a_metre = 1 / (high - low);
  planned.lookup.to_map_x = rowOf(rotation, 0);
  planned.lookup.to_map_y = rowOf(rotation, 1);
  planned.lookup.to_map_z =
      toFloat4(glm::row(rotation, 2) * depth_a_metre + glm::dvec4(0, 0, 0, (eye.z - low) * depth_a_metre));
  planned.lookup.depth_scale = float(depth_a_metre * depth_a_metre);
  planned.lookup.depth_offset = float(depth_a_metre);
  planned.lookup.penumbra_scale = float(std::tan(light.half_angle) / depth_a_metre);
  planned.lookup.filter_radius = float(lookupRadius(border, input.method));
  planned.lookup.kind = kParallelMap;
  return planned;
}

/// Adds a perspective face. Without the border on each side, the tangent of its half angle is `tangent`.
void addFace(const Light& light, const PlanInput& input, const glm::dmat4& world_to_light, double tangent,
             int size, PlannedMap& planned) {
  const int border = borderOf(size, input.method);
  const double reach = lightReach(light, input.bounds);
  const double half = 0.5 * size, scale = (half - border) / tangent;
  const glm::dmat4 projection =
      perspectiveProjection(2 * std::atan(half / scale), 1.0, reach * kNearShare, reach);
  planned.lookup.depth_scale = float(projection[3][2]);
  planned.lookup.depth_offset = float(-projection[2][2]);
  planned.lookup.penumbra_scale = float(light.radius / projection[3][2]);
  planned.lookup.filter_radius = float(lookupRadius(border, input.method));
  planned.views.push_back(squareView(world_to_light, projection, size));
  planned.faces.push_back(emptyFace(scale, {half, half}, size, border));
}

PlannedMap planPerspective(const Light& light, const PlanInput& input, int size) {
  const glm::dmat4 world_to_light = lookAlong(light.position, light.direction, glm::dvec3(0, 1, 0));
  PlannedMap planned;
  planned.lookup.kind = kPerspectiveMap;
  addFace(light, input, world_to_light, std::tan(std::max(light.cutoff, 1e-3)), size, planned);
  const glm::dmat4 view_to_light = world_to_light * input.view_to_world;
  planned.lookup.to_map_x = rowOf(view_to_light, 0);
  planned.lookup.to_map_y = rowOf(view_to_light, 1);
  planned.lookup.to_map_z = rowOf(-view_to_light, 2);
  return planned;
}

PlannedMap planCube(const Light& light, const PlanInput& input, int size) {
  PlannedMap planned;
  planned.lookup.kind = kCubeMap;
  for (int face = 0; face < 6; ++face) {
    // Right, up and backward axes as cube_point() in kernels/maps/shadow.clh has them.
    const int axis = face / 2;
    const double sign = face % 2 ? -1.0 : 1.0;
    glm::dvec3 right(0), up(0), backward(0);
    right[(axis + 2) % 3] = sign;
    up[(axis + 1) % 3] = 1;
    backward[axis] = -sign;
    const glm::dmat4 light_to_world(glm::dvec4(right, 0), glm::dvec4(up, 0), glm::dvec4(backward, 0),
                                    glm::dvec4(light.position, 1));
    addFace(light, input, glm::inverse(light_to_world), 1.0, size, planned);
  }
  const glm::dmat4 view_to_way = glm::translate(glm::dmat4(1), -light.position) * input.view_to_world;
  planned.lookup.to_map_x = rowOf(view_to_way, 0);
  planned.lookup.to_map_y = rowOf(view_to_way, 1);
  planned.lookup.to_map_z = rowOf(view_to_way, 2);
  return planned;
}

}  // namespace

bool usesCubeMap(const Light& light) {
  return light.kind == LightKind::kPoint || (light.kind == LightKind::kSpot && light.cutoff > kWidestSpot);
}

int facesOf(const Light& light) {
  return usesCubeMap(light) ? 6 : light.kind == LightKind::kDirectional ? kCascades : 1;
}

int borderOf(int size, ShadowMethod method) {
  constexpr int kNarrow = 4, kWidest = 64;
  return method == ShadowMethod::kSoft ? std::clamp(size / 10, kNarrow, kWidest) : kNarrow;
}

double lightReach(const Light& light, const Bounds& scene) {
  double farthest = kSmallestLength;
  for (const glm::dvec3& corner : boxCorners(scene))
    farthest = std::max(farthest, glm::distance(corner, light.position));
  return std::min(double(light.range), farthest * 1.001);
}

PlannedMap planMap(const Light& light, const PlanInput& input, int size) {
  if (usesCubeMap(light)) return planCube(light, input, size);
  if (light.kind == LightKind::kDirectional) return planParallel(light, input, size);
  return planPerspective(light, input, size);
}

}  // namespace luciole
