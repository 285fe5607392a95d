#include "shadow/shadow_maps.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <glm/gtc/matrix_access.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <numeric>
#include <optional>

#include "base/error.hpp"
#include "raster/bins.hpp"
#include "raster/bound_depth.hpp"
#include "raster/geometry.hpp"
#include "raster/rasterize.hpp"
#include "scene/bounds.hpp"

namespace luciole {
namespace {

/// Texels around a lookup that it may read, and that are drawn around a cone or a cube's face for its sake.
/// Soft shadows may spread over an eighth of what a face shows.
int borderOf(int size, ShadowMethod method) {
  constexpr int kNarrow = 4, kWidest = 64;
  return method == ShadowMethod::kSoft ? std::clamp(size / 10, kNarrow, kWidest) : kNarrow;
}

static_assert(kShadowBin == kBinSize);  // so that a bin is drawn or not

constexpr int kCascades = 4;
/// How much farther a cascade reaches than the one before.
constexpr double kCascadeRatio = 3.0;

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

/// A light's map on its way.
struct PlannedMap {
  ShadowMap lookup{};
  std::vector<ShadowFace> faces;
  std::vector<View> views;
};

/// What the maps are planned for.
struct Plan {
  const View& camera;
  ShadowMethod method;
  glm::dmat4 view_to_world;
  Bounds bounds;  ///< of the scene, world
};

View squareView(const glm::dmat4& world_to_view, const glm::dmat4& projection, int size) {
  View view;
  view.world_to_view = world_to_view;
  view.projection = projection;
  view.size = view.crop_size = glm::ivec2(size);
  return view;
}

/// A face that nothing was drawn to.
ShadowFace emptyFace(double scale, const glm::dvec2& middle, int size, int border) {
  ShadowFace face{};
  face.scale = float(scale);
  face.middle_x = float(middle.x);
  face.middle_y = float(middle.y);
  face.low = float(border);
  face.high = float(size - border);
  return face;
}

/// A row of a matrix that takes view-space points.
float4 rowOf(const glm::dmat4& m, int row) { return toFloat4(glm::row(m, row)); }

struct Sphere {
  glm::dvec3 middle;
  double radius;
};

/// Around the part of a view from `near` to `far` metres ahead.
Sphere sphereAround(const View& view, double near, double far) {
  const Corners corners = viewCorners(view);
  // Corners i and i + 4 are the near and the far end of an edge.
  const double view_near = -(view.world_to_view * glm::dvec4(corners[4], 1)).z;
  const double view_far = -(view.world_to_view * glm::dvec4(corners[0], 1)).z;
  std::array<glm::dvec3, 8> part;
  for (int i = 0; i < 4; ++i) {
    const auto at = [&](double depth) {
      return glm::mix(corners[i + 4], corners[i], (depth - view_near) / (view_far - view_near));
    };
    part[i] = at(near);
    part[i + 4] = at(far);
  }
  const auto middleOf = [&](int first) {
    return 0.25 * (part[first] + part[first + 1] + part[first + 2] + part[first + 3]);
  };
  const auto farthestFrom = [&](const glm::dvec3& middle) {
    double radius = 0;
    for (const glm::dvec3& p : part) radius = std::max(radius, glm::distance(p, middle));
    return radius;
  };
  // On the axis, as far from the near corners as from the far ones, unless those alone need more.
  const glm::dvec3 a = middleOf(0), b = middleOf(4);
  const double length2 = glm::dot(b - a, b - a);
  const double near2 = glm::dot(part[0] - a, part[0] - a), far2 = glm::dot(part[4] - b, part[4] - b);
  const double share = length2 > 0 ? std::clamp(0.5 + 0.5 * (far2 - near2) / length2, 0.0, 1.0) : 0.5;
  const glm::dvec3 middle = glm::mix(a, b, share);
  return {middle, farthestFrom(middle)};
}

/// How far ahead the camera sees anything of the scene, in metres: nearest and farthest.
glm::dvec2 seenDepths(const Plan& plan) {
  const Corners box = boxCorners(plan.bounds), seen = viewCorners(plan.camera);
  std::vector<glm::dvec3> points;
  appendClippedFaces(seen, box, points);
  appendClippedFaces(box, seen, points);
  if (points.empty()) points.assign(box.begin(), box.end());  // nothing to see: any depths will do
  glm::dvec2 depths(1e300, kSmallestLength);
  for (const glm::dvec3& point : points) {
    const double depth = -(plan.camera.world_to_view * glm::dvec4(point, 1)).z;
    depths = {std::min(depths.x, depth), std::max(depths.y, depth)};
  }
  return depths;
}

/// What a directional light's cascades cover, the finest first.
std::vector<Sphere> cascadeSpheres(const Plan& plan) {
  const glm::dvec2 depths = seenDepths(plan);
  const Sphere all{0.5 * (plan.bounds.low + plan.bounds.high),
                   0.5 * glm::distance(plan.bounds.low, plan.bounds.high)};
  if (!isPerspective(plan.camera)) {
    const Sphere seen = sphereAround(plan.camera, depths.x, depths.y);
    return {seen.radius < all.radius ? seen : all};
  }
  // In steps, so that a moving camera rarely changes a texel's size.
  const double farthest = std::exp2(std::ceil(2 * std::log2(depths.y)) / 2);
  std::vector<Sphere> spheres;
  double near = 0;
  for (int cascade = 0; cascade < kCascades; ++cascade) {
    const double far = farthest * std::pow(kCascadeRatio, cascade + 1 - kCascades);
    const Sphere part = sphereAround(plan.camera, near, far);
    near = far;
    if (part.radius >= all.radius) {
      spheres.push_back(all);
      break;
    }
    spheres.push_back(part);
  }
  return spheres;
}

PlannedMap planParallel(const Light& light, const Plan& plan, int size) {
  // The axes depend on the light alone.
  const glm::dmat4 world_to_light = lookAlong(glm::dvec3(0), light.direction, glm::dvec3(0, 1, 0));
  double low = 1e300, high = -1e300;  // everything between what is seen and the light casts
  for (const glm::dvec3& corner : boxCorners(plan.bounds)) {
    const double towards = (world_to_light * glm::dvec4(corner, 1)).z;
    low = std::min(low, towards);
    high = std::max(high, towards);
  }
  const glm::dvec3 eye(world_to_light * plan.view_to_world[3]);
  const glm::dmat4 rotation = world_to_light * glm::dmat4(glm::dmat3(plan.view_to_world));
  // Room for scenes that are flat: more than what doubles lose far from the origin, 2⁻⁵³ of the distance in
  // each of some ten operations.
  const double across = glm::distance(plan.bounds.low, plan.bounds.high);
  const double least =
      std::max({kSmallestLength, 1e-6 * across,
                1e-14 * std::max(glm::length(plan.bounds.low), glm::length(plan.bounds.high))});
  low -= least;
  high += least;

  PlannedMap planned;
  const int border = borderOf(size, plan.method);
  // Even the widest penumbra is to fit into a lookup's reach.
  const double least_texel =
      plan.method == ShadowMethod::kSoft ? std::tan(light.half_angle) * (high - low) / (border - 2) : 0;
  for (const Sphere& sphere : cascadeSpheres(plan)) {
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
  planned.lookup.spread = float(std::tan(light.half_angle) / depth_a_metre);
  planned.lookup.reach = float(border);
  planned.lookup.kind = kParallelMap;
  return planned;
}

/// Distance that a light with a place can cast shadows over: its range, or to the scene's farthest corner
/// where that is less.
double lightReach(const Light& light, const Bounds& scene) {
  double farthest = kSmallestLength;
  for (const glm::dvec3& corner : boxCorners(scene))
    farthest = std::max(farthest, glm::distance(corner, light.position));
  return std::min(double(light.range), farthest * 1.001);
}

/// Adds a face that shows tangents up to `tangent`, and the border on each side.
void addFace(const Light& light, const Plan& plan, const glm::dmat4& world_to_light, double tangent, int size,
             PlannedMap& planned) {
  const int border = borderOf(size, plan.method);
  const double reach = lightReach(light, plan.bounds);
  const double half = 0.5 * size, scale = (half - border) / tangent;
  const glm::dmat4 projection =
      perspectiveProjection(2 * std::atan(half / scale), 1.0, reach * kNearShare, reach);
  planned.lookup.depth_scale = float(projection[3][2]);
  planned.lookup.depth_offset = float(-projection[2][2]);
  planned.lookup.spread = float(light.radius / projection[3][2]);
  planned.lookup.reach = float(border);
  planned.views.push_back(squareView(world_to_light, projection, size));
  planned.faces.push_back(emptyFace(scale, {half, half}, size, border));
}

PlannedMap planPerspective(const Light& light, const Plan& plan, int size) {
  const glm::dmat4 world_to_light = lookAlong(light.position, light.direction, glm::dvec3(0, 1, 0));
  PlannedMap planned;
  planned.lookup.kind = kPerspectiveMap;
  addFace(light, plan, world_to_light, std::tan(std::max(light.cutoff, 1e-3)), size, planned);
  const glm::dmat4 view_to_light = world_to_light * plan.view_to_world;
  planned.lookup.to_map_x = rowOf(view_to_light, 0);
  planned.lookup.to_map_y = rowOf(view_to_light, 1);
  planned.lookup.to_map_z = rowOf(-view_to_light, 2);
  return planned;
}

PlannedMap planCube(const Light& light, const Plan& plan, int size) {
  PlannedMap planned;
  planned.lookup.kind = kCubeMap;
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
    addFace(light, plan, glm::inverse(light_to_world), 1.0, size, planned);
  }
  const glm::dmat4 view_to_way = glm::translate(glm::dmat4(1), -light.position) * plan.view_to_world;
  planned.lookup.to_map_x = rowOf(view_to_way, 0);
  planned.lookup.to_map_y = rowOf(view_to_way, 1);
  planned.lookup.to_map_z = rowOf(view_to_way, 2);
  return planned;
}

int facesOf(const Light& light) {
  return usesCubeMap(light) ? 6 : light.kind == LightKind::kDirectional ? kCascades : 1;
}

/// Planes of the part of clip space that a view's crop covers, as world-space (n, d) with n·p + d ≥ 0 inside.
std::array<glm::dvec4, 6> cropPlanes(const View& view) {
  const glm::dmat4 m = view.projection * view.world_to_view;
  const glm::dvec4 x = glm::row(m, 0), y = glm::row(m, 1), z = glm::row(m, 2), w = glm::row(m, 3);
  const glm::dvec2 size(view.size), first(view.crop_origin), last = first + glm::dvec2(view.crop_size);
  const auto ndcX = [&](double pixel) { return -1 + 2 * pixel / size.x; };
  const auto ndcY = [&](double pixel) { return 1 - 2 * pixel / size.y; };
  return {x - ndcX(first.x) * w, ndcX(last.x) * w - x, ndcY(first.y) * w - y, y - ndcY(last.y) * w, w - z, z};
}

/// Texels a side that make a texel as large as a pixel where the light reaches, halfway to the end of its
/// reach.
double wantedSize(const Light& light, const Plan& plan) {
  const double reach = lightReach(light, plan.bounds);
  const glm::dmat4& projection = plan.camera.projection;
  const glm::dvec3 place(plan.camera.world_to_view * glm::dvec4(light.position, 1));
  for (const glm::dvec4& plane : cropPlanes(plan.camera))
    if (glm::dot(plane, glm::dvec4(light.position, 1)) < -reach * glm::length(glm::dvec3(plane))) return 0;
  // A pixel's height in metres, at one metre ahead if the view is a perspective one.
  double pixel = 2 / (projection[1][1] * plan.camera.size.y);
  if (isPerspective(plan.camera)) pixel *= std::max(glm::length(place), 0.5 * reach);
  const double tangent = usesCubeMap(light) ? 1.0 : std::tan(light.cutoff);
  return reach * tangent / pixel;
}

int largestSize(const Light& light, const ShadowLimits& limits) {
  return std::max(usesCubeMap(light) ? limits.size / 2 : limits.size, kSmallestFace);
}

/// A face's texels a side where `wanted` of them should show something, `largest` at most.
int withBorder(double wanted, ShadowMethod method, int largest) {
  const double size = std::ceil(std::min(wanted, double(largest)));
  return std::clamp(int(size) + 2 * borderOf(int(size), method), kSmallestFace, largest);
}

/// What exact maps leave unsure takes rays; half as many texels a side leave twice as much of it, but cost a
/// quarter, which is less in all.
double sizeShare(ShadowMethod method) { return method == ShadowMethod::kExact ? 0.5 : 1.0; }

/// Texels a side of every light's faces, and how many lights have less than they want.
std::vector<int> chooseSizes(const Scene& scene, const Plan& plan, const ShadowLimits& limits,
                             std::uint64_t& reduced) {
  std::vector<int> wanted(scene.lights.size(), 0);
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    const Light& light = scene.lights[i];
    if (!light.shadow) continue;
    const double share = sizeShare(plan.method);
    const int largest = std::max(int(share * largestSize(light, limits)), kSmallestFace);
    wanted[i] = light.kind == LightKind::kDirectional
                    ? largest
                    : withBorder(share * wantedSize(light, plan), plan.method, largest);
  }
  const auto scaled = [](int size, double scale) { return std::max(int(size * scale), kSmallestFace); };
  const auto bytesAt = [&](double scale) {
    double texels = 0;
    for (std::size_t i = 0; i < wanted.size(); ++i)
      if (wanted[i] > 0) texels += facesOf(scene.lights[i]) * std::pow(double(scaled(wanted[i], scale)), 2);
    return texels * (plan.method == ShadowMethod::kExact ? sizeof(BoundTexel) : sizeof(ShadowTexel));
  };
  double scale = 1;
  while (bytesAt(scale) > double(limits.bytes)) {
    if (scale < 1e-4)
      throw MachineError(fmt::format("{}: the shadow maps of its lights don't fit into {} MiB", scene.name,
                                     limits.bytes >> 20));
    scale *= 0.95;
  }
  for (int& size : wanted) {
    if (size == 0) continue;
    const int less = scaled(size, scale);
    reduced += less < size;
    size = less;
  }
  return wanted;
}

/// Whether a box may reach inside the planes, and to a sphere.
bool mayShow(const std::array<glm::dvec4, 6>& planes, const glm::dvec3& low, const glm::dvec3& high,
             const Light& light) {
  for (const glm::dvec4& plane : planes) {
    const glm::dvec3 corner(plane.x > 0 ? high.x : low.x, plane.y > 0 ? high.y : low.y,
                            plane.z > 0 ? high.z : low.z);
    if (glm::dot(plane, glm::dvec4(corner, 1)) < 0) return false;
  }
  if (light.kind == LightKind::kDirectional) return true;
  return !(glm::distance(glm::clamp(light.position, low, high), light.position) > light.range);
}

/// The bins of a rectangle of a view: farthest[i] as in rasterizeDepth.
struct WantedBins {
  glm::ivec2 first, count;  ///< in bins of the whole view
  std::vector<float> farthest;
};

/// Whether a box may show in any of the bins, not beyond what matters there.
bool mayMatter(const glm::dmat4& world_to_clip, const glm::ivec2& size, const WantedBins& bins,
               const glm::dvec3& low, const glm::dvec3& high) {
  glm::dvec2 first(1e300), last(-1e300);
  double nearest = 0;
  for (int i = 0; i < 8; ++i) {
    const glm::dvec4 clip =
        world_to_clip * glm::dvec4(i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z, 1);
    if (!(clip.z <= clip.w)) return true;  // reaches behind the near plane, or isn't finite
    const glm::dvec2 place =
        glm::dvec2(0.5 + 0.5 * clip.x / clip.w, 0.5 - 0.5 * clip.y / clip.w) * glm::dvec2(size);
    first = glm::min(first, place);
    last = glm::max(last, place);
    nearest = std::max(nearest, clip.z / clip.w);
  }
  // No whole number is as large as places beside a face can be.
  first = glm::clamp(first, glm::dvec2(-2.0 * kBinSize), glm::dvec2(size + 2 * kBinSize));
  last = glm::clamp(last, glm::dvec2(-2.0 * kBinSize), glm::dvec2(size + 2 * kBinSize));
  // A texel more on each side for snapping, and a float's rounding of depth.
  const glm::ivec2 from =
      glm::max(glm::ivec2(glm::floor((first - 1.0) / double(kBinSize))), bins.first) - bins.first;
  const glm::ivec2 to =
      glm::min(glm::ivec2(glm::floor((last + 1.0) / double(kBinSize))), bins.first + bins.count - 1) -
      bins.first;
  const float depth = float(nearest) * (1 + 0x1p-22f);
  for (int y = from.y; y <= to.y; ++y)
    for (int x = from.x; x <= to.x; ++x)
      if (bins.farthest[y * bins.count.x + x] <= depth) return true;
  return false;
}

std::vector<std::uint32_t> runsSeen(const TriangleRuns& runs, const View& view, const WantedBins& bins,
                                    const Light& light) {
  const auto planes = cropPlanes(view);
  const glm::dmat4 world_to_clip = view.projection * view.world_to_view;
  const auto seen = [&](const glm::dvec3& low, const glm::dvec3& high) {
    return mayShow(planes, low, high, light) && mayMatter(world_to_clip, view.size, bins, low, high);
  };
  std::vector<std::uint32_t> result;
  for (std::uint32_t group = 0; group < runs.groups.size(); ++group) {
    if (!seen(runs.groups[group].low, runs.groups[group].high)) continue;
    const std::uint32_t end = std::min<std::uint32_t>((group + 1) * kRunsPerGroup, runs.runs.size());
    for (std::uint32_t run = group * kRunsPerGroup; run < end; ++run)
      if (seen(runs.runs[run].low, runs.runs[run].high)) result.push_back(run);
  }
  return result;
}

constexpr float kNever = std::numeric_limits<float>::infinity();

/// A face that must be drawn to.
struct Task {
  std::size_t face;
  bool moves;               ///< its rectangle grows, so it gets a new place and all its bins are drawn
  std::vector<bool> fresh;  ///< bins to draw
};

/// What of a face must be drawn, if anything; notes it in the face.
std::optional<Task> taskOf(std::size_t index, const ShadowFace& lookup, std::span<const std::uint32_t> needed,
                           PlannedFace& face) {
  const int side = int(lookup.bins);
  if (face.farthest.empty()) face.farthest.assign(std::size_t(side) * side, kNever);
  Task task{index, false, std::vector<bool>(face.farthest.size())};
  bool any = false;
  glm::ivec2 first(side), last(-1);
  for (int bin = 0; bin < side * side; ++bin) {
    const std::uint32_t bits = needed[lookup.first_bin + bin];
    const float depth = bits == kNotNeeded ? kNever : std::bit_cast<float>(bits);
    if (depth < face.farthest[bin]) {
      face.farthest[bin] = depth;
      task.fresh[bin] = any = true;
    }
    if (face.farthest[bin] == kNever) continue;
    first = glm::min(first, glm::ivec2(bin % side, bin / side));
    last = glm::max(last, glm::ivec2(bin % side, bin / side));
  }
  if (!any) return std::nullopt;
  const glm::ivec2 from = first * kBinSize, to = glm::min((last + 1) * kBinSize, face.view.size);
  task.moves = from != face.first || to - from != face.count;
  face.first = from;
  face.count = to - from;
  return task;
}

std::size_t area(const glm::ivec2& size) { return std::size_t(size.x) * size.y; }

/// Adds the texels that a face's task draws. place: as in drawFace.
void addDrawn(const Task& task, const PlannedFace& face, std::size_t place, std::vector<IndexRange>& drawn) {
  if (task.moves) {
    drawn.push_back({place, area(face.count)});
    return;
  }
  const int side = (face.view.size.x + kBinSize - 1) / kBinSize;
  const auto width = std::size_t(face.count.x);
  for (int bin = 0; bin < side * side; ++bin) {
    if (!task.fresh[bin]) continue;
    const glm::ivec2 first = glm::ivec2(bin % side, bin / side) * kBinSize - face.first;
    const glm::ivec2 count = glm::min(face.count - first, kBinSize);
    drawn.push_back({place + std::size_t(first.y) * width + std::size_t(first.x), std::size_t(count.x),
                     std::size_t(count.y), width});
  }
}

/// place: of the face's rectangle among the texels.
void drawFace(const Scene& scene, const Task& task, const PlannedFace& face, std::size_t place,
              ShadowMaps& maps) {
  View view = face.view;
  view.crop_origin = face.first;
  view.crop_size = face.count;
  const int side = (view.size.x + kBinSize - 1) / kBinSize;
  WantedBins bins{face.first / kBinSize, (face.count + kBinSize - 1) / kBinSize, {}};
  for (int y = 0; y < bins.count.y; ++y) {
    for (int x = 0; x < bins.count.x; ++x) {
      const int bin = (bins.first.y + y) * side + bins.first.x + x;
      bins.farthest.push_back(task.moves || task.fresh[bin] ? face.farthest[bin] : kNever);
    }
  }
  const std::vector<std::uint32_t> seen = runsSeen(maps.runs, view, bins, scene.lights[face.light]);
  if (maps.method == ShadowMethod::kExact)
    rasterizeBounds(scene, maps.runs, seen, view, bins.farthest,
                    std::span(maps.bounds).subspan(place, area(face.count)));
  else
    rasterizeDepth(scene, maps.runs, seen, view, bins.farthest,
                   std::span(maps.texels).subspan(place, area(face.count)));
}

}  // namespace

bool usesCubeMap(const Light& light) {
  return light.kind == LightKind::kPoint || (light.kind == LightKind::kSpot && light.cutoff > kWidestSpot);
}

ShadowMaps planShadowMaps(const Scene& scene, const View& camera_view, ShadowMethod method,
                          const ShadowLimits& limits) {
  ShadowMaps result;
  result.method = method;
  result.map_of_light.assign(scene.lights.size(), kNoShadow);
  Plan plan{camera_view, method, glm::inverse(camera_view.world_to_view), {}};
  for (const Object& object : scene.objects) {
    const Bounds bounds = objectBounds(scene, object);
    plan.bounds.low = glm::min(plan.bounds.low, bounds.low);
    plan.bounds.high = glm::max(plan.bounds.high, bounds.high);
  }
  if (plan.bounds.low.x > plan.bounds.high.x) return result;

  const std::vector<int> sizes = chooseSizes(scene, plan, limits, result.reduced_lights);
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    const Light& light = scene.lights[i];
    if (!light.shadow) continue;
    PlannedMap map = usesCubeMap(light)                      ? planCube(light, plan, sizes[i])
                     : light.kind == LightKind::kDirectional ? planParallel(light, plan, sizes[i])
                                                             : planPerspective(light, plan, sizes[i]);
    map.lookup.first_face = static_cast<uint>(result.faces.size());
    map.lookup.face_count = static_cast<uint>(map.faces.size());
    result.map_of_light[i] = static_cast<std::uint32_t>(result.maps.size());
    result.maps.push_back(map.lookup);
    for (ShadowFace face : map.faces) {
      face.bins = uint((sizes[i] + kBinSize - 1) / kBinSize);
      face.first_bin = uint(result.bin_count);
      result.bin_count += std::size_t(face.bins) * face.bins;
      result.faces.push_back(face);
    }
    for (const View& view : map.views)
      result.planned.push_back({.light = static_cast<std::uint32_t>(i), .view = view, .farthest = {}});
    result.planned_texels += map.views.size() * std::size_t(sizes[i]) * sizes[i];
  }
  if (!result.maps.empty()) result.runs = findRuns(scene);
  return result;
}

std::vector<IndexRange> drawNeeded(const Scene& scene, std::span<const std::uint32_t> needed,
                                   ShadowMaps& maps) {
  std::vector<Task> tasks;
  const bool exact = maps.method == ShadowMethod::kExact;
  std::size_t held = exact ? maps.bounds.size() : maps.texels.size(), total = held;
  for (std::size_t i = 0; i < maps.planned.size(); ++i) {
    if (auto task = taskOf(i, maps.faces[i], needed, maps.planned[i])) {
      if (task->moves) total += area(maps.planned[i].count);
      tasks.push_back(std::move(*task));
    }
  }
  // Rectangles that moved leave their old places empty: where that takes more than was planned, all move
  // together.
  if (total > maps.planned_texels) {
    held = 0;
    tasks.clear();
    for (std::size_t i = 0; i < maps.planned.size(); ++i)
      if (maps.planned[i].count.x > 0) tasks.push_back({i, true, {}});
  }
  total = held;
  for (const Task& task : tasks) {
    if (!task.moves) continue;
    const PlannedFace& face = maps.planned[task.face];
    ShadowFace& lookup = maps.faces[task.face];
    lookup.width = uint(face.count.x);
    lookup.first = uint(total) - uint(face.first.y) * lookup.width - uint(face.first.x);
    total += area(face.count);
  }
  if (exact)
    maps.bounds.resize(total);
  else
    maps.texels.resize(total);
  const auto placeOf = [&](const Task& task) {
    const glm::ivec2 first = maps.planned[task.face].first;
    const ShadowFace& lookup = maps.faces[task.face];
    return std::size_t(uint(lookup.first + uint(first.y) * lookup.width + uint(first.x)));
  };
  std::vector<IndexRange> drawn;
  for (const Task& task : tasks) addDrawn(task, maps.planned[task.face], placeOf(task), drawn);
  tbb::parallel_for(std::size_t(0), tasks.size(), [&](std::size_t i) {
    drawFace(scene, tasks[i], maps.planned[tasks[i].face], placeOf(tasks[i]), maps);
  });
  return drawn;
}

}  // namespace luciole
