#include "reference/gbuffer_check.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

#include "raster/geometry.hpp"
#include "raster/lift.hpp"
#include "raster/opacity.hpp"
#include "rays/ray_cast.hpp"

namespace luciole {
namespace {

/// Two surfaces on a ray tie if they are nearer to each other than this share of their distance from the eye.
constexpr double kSamePlace = 1e-6;

/// Normals farther apart than this, in radians, belong to different surfaces.
constexpr double kSameNormal = 1e-5;

/// The same for normals that a map bends. Its texture coordinates are floats: one of up to 16 is off by 2⁻²¹,
/// which in a picture of 4096 texels is 1/512 of a texel. Neighbouring texels may differ by a right angle, so
/// a scale of 1 turns a normal by up to 2 · 2 / 512 along both axes.
constexpr double kSameBentNormal = 8e-3;

/// A scene for rays in view space.
struct Tracer {
  const Scene& scene;
  const View& view;
  glm::dmat4 view_to_world;
  Geometry geometry;
  ViewPlane plane;
  RayScene rays;
};

/// A surface on a pixel's ray.
struct SurfaceHit {
  std::uint32_t triangle;
  glm::dvec3 position;
  glm::dvec3 normal;  ///< as shaded: interpolated, on the side of the eye
  double lift;        ///< to where shadow tests start
  bool bent = false;  ///< a normal map bends the normal
  double depth;       ///< metres along the view axis
};

/// The triangles that this thread's current ray has hit so far.
thread_local std::vector<std::uint32_t> hit_triangles;

Tracer makeTracer(const Scene& scene, const View& view) {
  // The filter rejects every hit, so that a ray visits all triangles. The nearest one is found in double
  // precision.
  const HitFilter note = [](const CandidateHit& candidate) {
    hit_triangles.push_back(candidate.triangle);
    return true;
  };
  const glm::dmat4 view_to_world = viewCamera(view).camera_to_world;
  return {scene,           view,
          view_to_world,   transformObjects(scene, allObjects(scene), view),
          viewPlane(view), buildRayScene(scene, glm::dvec3(view_to_world[3]), note)};
}

struct Ray {
  glm::dvec3 from, direction;  ///< view space; the direction is 1 long along the view axis
};

/// (x, y): pixels of the whole picture from the sample of its first, as in ScreenVertex.
Ray viewRay(const ViewPlane& plane, const glm::dvec2& at) {
  const glm::dvec2 place = plane.offset + plane.scale * at;
  return plane.perspective ? Ray{glm::dvec3(0), glm::dvec3(place, -1)}
                           : Ray{glm::dvec3(place, 0), glm::dvec3(0, 0, -1)};
}

std::array<glm::dvec3, 3> cornersOf(const Geometry& geometry, std::uint32_t triangle) {
  const PlacedObject& object = objectOfTriangle(geometry.objects, triangle);
  const glm::uvec3 corners = object.mesh->triangles[triangle - object.first_triangle];
  const glm::dvec3* positions = geometry.positions.data() + object.first_vertex;
  return {positions[corners[0]], positions[corners[1]], positions[corners[2]]};
}

/// Whether each corner's normal leans from its triangle's, by less than a right angle.
glm::bvec3 leaningCorners(const Mesh& mesh, const glm::uvec3& corners) {
  const std::array<glm::dvec3, 3> p{mesh.positions[corners.x], mesh.positions[corners.y],
                                    mesh.positions[corners.z]};
  const glm::dvec3 own = glm::normalize(glm::cross(p[1] - p[0], p[2] - p[0]));
  glm::bvec3 leans;
  for (int i = 0; i < 3; ++i) {
    const glm::dvec3 normal(mesh.normals[corners[i]]);
    const double cosine = glm::dot(normal, own);
    leans[i] = cosine > 0 && glm::length(normal - cosine * own) / cosine > kFlatAngle;
  }
  return leans;
}

/// The lift of a point of a facet (raster/lift.hpp). Its projections onto the tangent planes of the corners
/// that lie above it (Hanika 2021) are on average `up` higher. The lift is half of that, or as much of it as
/// puts all corners behind the plane on which the shading normal stands. normals: of the corners, on the side
/// of the eye and of the same length in the mesh's space; sum: their average. A corner that doesn't lean has
/// the facet's own plane.
double liftAt(const glm::dvec3& point, const glm::dvec3& shares, const std::array<glm::dvec3, 3>& corners,
              const glm::dmat3& normals, const glm::dvec3& sum, const glm::bvec3& leans) {
  const double length = glm::length(sum);
  if (length == 0) return 0;
  double up = 0, in_front = 0, longest = 0;
  for (int i = 0; i < 3; ++i) {
    const double weight = glm::length(normals[i]);
    const double below = leans[i] ? -glm::dot(point - corners[i], normals[i] / weight) : 0.0;
    up += shares[i] * std::max(below, 0.0) * weight / length;
    in_front = std::max(in_front, glm::dot(corners[i] - point, sum / length));
    longest = std::max(longest, glm::distance(corners[i], corners[(i + 1) % 3]));
  }
  return std::min(std::clamp(in_front, up / 2, up), longest / 2);
}

/// Bends the normal of a hit by the normal map. `side`: 1 on the triangle's front, −1 on its back. The frame
/// that the map is given in has its third axis along the normal, its first as near to the tangent as that
/// allows, and its second on the side of the tangent's w. In a space that the object's transform mirrors that
/// is the other side.
void bend(const Tracer& tracer, std::uint32_t triangle, const glm::ivec2& pixel, const glm::dvec3& shares,
          double side, SurfaceHit& hit) {
  const Surface surface = makeSurface(tracer.scene, tracer.geometry.objects, triangle, tracer.plane);
  const Mesh& mesh = *surface.object->mesh;
  const auto corner = [&](const auto& values, int i) { return values[surface.corners[i]]; };
  glm::dvec4 given(0);
  for (int i = 0; i < 3; ++i) given += shares[i] * glm::dvec4(corner(mesh.tangents, i));
  const glm::dvec3 normal = side * hit.normal;
  const glm::dvec3 along = glm::dmat3(surface.object->object_to_view) * glm::dvec3(given);
  const glm::dvec3 first = along - normal * glm::dot(along, normal);
  if (!(glm::length(first) > 1e-6 * glm::length(along))) return;
  glm::dmat3 frame(glm::normalize(first), glm::dvec3(0), normal);
  frame[1] = glm::cross(normal, frame[0]) * ((given.w < 0) != surface.object->mirrored ? -1.0 : 1.0);
  const std::vector<glm::vec2>& uvs = mesh.normal_uvs.empty() ? mesh.uvs : mesh.normal_uvs;
  const auto uvAt = [&](const glm::dvec2& step) {
    const Weights weights = weightsInPlane(surface, tracer.plane.at(pixel.x + step.x, pixel.y + step.y));
    return weights[0] * glm::dvec2(corner(uvs, 0)) + weights[1] * glm::dvec2(corner(uvs, 1)) +
           weights[2] * glm::dvec2(corner(uvs, 2));
  };
  const glm::dvec2 here = uvAt({0, 0});
  const TexturePlace place{
      glm::vec2(shares[0] * glm::dvec2(corner(uvs, 0)) + shares[1] * glm::dvec2(corner(uvs, 1)) +
                shares[2] * glm::dvec2(corner(uvs, 2))),
      glm::vec2(uvAt({1, 0}) - here), glm::vec2(uvAt({0, 1}) - here)};
  glm::dvec3 in_frame;
  for (int c = 0; c < 3; ++c)
    in_frame[c] = 2.0 * lookUp(tracer.scene, surface.material->normal_map, place, c) - 1;
  in_frame *= glm::dvec3(glm::dvec2(surface.material->normal_scale), 1);
  in_frame.z = std::max(in_frame.z, 0.0);
  if (!(glm::length(in_frame) > 1.0 / 256)) return;
  hit.normal = side * (frame * glm::normalize(in_frame));
  hit.lift /= std::max(glm::normalize(in_frame).z, 0.5);
  hit.bent = true;
}

/// Where the ray meets the triangle's plane. Empty for a triangle that the picture doesn't show here: it
/// faces away and is single-sided, has a hole at this pixel, or isn't between the near and the far plane.
std::optional<SurfaceHit> intersect(const Tracer& tracer, const Ray& ray, std::uint32_t triangle,
                                    const glm::ivec2& pixel) {
  const PlacedObject& object = objectOfTriangle(tracer.geometry.objects, triangle);
  const std::uint32_t in_mesh = triangle - object.first_triangle;
  const Material& material = materialOf(tracer.scene, object, in_mesh);
  const auto [a, b, c] = cornersOf(tracer.geometry, triangle);
  const glm::dvec3 edge1 = b - a, edge2 = c - a;
  // T. Möller and B. Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection", 1997.
  const glm::dvec3 p = glm::cross(ray.direction, edge2);
  const double determinant = glm::dot(edge1, p);
  const bool front = (determinant > 0) != object.mirrored;
  if (determinant == 0 || (!front && !material.double_sided)) return std::nullopt;
  const glm::dvec3 t = ray.from - a, q = glm::cross(t, edge1);
  const double second = glm::dot(t, p) / determinant, third = glm::dot(ray.direction, q) / determinant;
  SurfaceHit hit;
  hit.triangle = triangle;
  hit.depth = glm::dot(edge2, q) / determinant - ray.from.z;
  hit.position = ray.from + ray.direction * (hit.depth + ray.from.z);
  const glm::dvec4 clip = tracer.view.projection * glm::dvec4(hit.position, 1);
  if (!(clip.z >= 0 && clip.z <= clip.w)) return std::nullopt;
  if (hasHoles(material) &&
      isHole(tracer.scene, makeSurface(tracer.scene, tracer.geometry.objects, triangle, tracer.plane),
             tracer.plane, pixel, pixel, tracer.view.number))
    return std::nullopt;
  const glm::uvec3 corners = object.mesh->triangles[in_mesh];
  const std::vector<glm::vec3>& normals = object.mesh->normals;
  const double side = front ? 1.0 : -1.0;
  const glm::dmat3 of_corners =
      side * object.normal_to_view * glm::dmat3(normals[corners.x], normals[corners.y], normals[corners.z]);
  const glm::dvec3 shares(1 - second - third, second, third), sum = of_corners * shares;
  const double length = glm::length(sum);
  const glm::dvec3 own = glm::normalize(glm::cross(edge1, edge2)) * (object.mirrored ? -side : side);
  hit.normal = length > 0 ? sum / length : own;
  hit.lift = liftAt(hit.position, shares, {a, b, c}, of_corners, sum, leaningCorners(*object.mesh, corners));
  if (material.normal_map.texture >= 0 && !object.mesh->tangents.empty())
    bend(tracer, triangle, pixel, shares, side, hit);
  return hit;
}

/// All surfaces that the pixel's ray through `at` meets and that the picture could show, the nearest first.
std::vector<SurfaceHit> follow(const Tracer& tracer, const glm::dvec2& at, const glm::ivec2& pixel) {
  const Ray ray = viewRay(tracer.plane, at);
  hit_triangles.clear();
  castRay(tracer.rays, glm::dvec3(tracer.view_to_world * glm::dvec4(ray.from, 1)),
          glm::normalize(glm::dmat3(tracer.view_to_world) * ray.direction));
  // Embree may hit a triangle that lies in two leaves of its tree twice.
  std::sort(hit_triangles.begin(), hit_triangles.end());
  hit_triangles.erase(std::unique(hit_triangles.begin(), hit_triangles.end()), hit_triangles.end());
  std::vector<SurfaceHit> hits;
  for (const std::uint32_t triangle : hit_triangles)
    if (const auto hit = intersect(tracer, ray, triangle, pixel)) hits.push_back(*hit);
  std::sort(hits.begin(), hits.end(),
            [](const SurfaceHit& a, const SurfaceHit& b) { return a.depth < b.depth; });
  return hits;
}

/// Distance in pixels of a place on the picture from the nearest of the lines that a triangle's edges lie on.
double distanceToEdges(const Tracer& tracer, std::uint32_t triangle, const glm::dvec2& at) {
  const std::array<glm::dvec3, 3> corners = cornersOf(tracer.geometry, triangle);
  // In homogeneous pixel coordinates, which are valid behind the eye, too.
  const auto pixels = [&](const glm::dvec3& corner) {
    const double w = tracer.plane.perspective ? -corner.z : 1.0;
    return glm::dvec3((glm::dvec2(corner) - tracer.plane.offset * w) / tracer.plane.scale, w);
  };
  double nearest = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i) {
    const glm::dvec3 line = glm::cross(pixels(corners[i]), pixels(corners[(i + 1) % 3]));
    nearest = std::min(nearest, std::abs(glm::dot(line, glm::dvec3(at, 1))) / glm::length(glm::dvec2(line)));
  }
  return nearest;
}

double distanceToTriangle(const std::array<glm::dvec3, 3>& corners, const glm::dvec3& p) {
  const glm::dvec3 normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
  bool inside = true;
  double nearest = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i) {
    const glm::dvec3 a = corners[i], edge = corners[(i + 1) % 3] - a;
    inside &= glm::dot(glm::cross(edge, p - a), normal) >= 0;
    const double share = std::clamp(glm::dot(p - a, edge) / glm::dot(edge, edge), 0.0, 1.0);
    nearest = std::min(nearest, glm::distance(p, a + share * edge));
  }
  return inside ? std::abs(glm::dot(normal, p - corners[0])) / glm::length(normal) : nearest;
}

/// What the G-buffer shows at a pixel.
struct Shown {
  glm::dvec3 position;
  glm::dvec3 normal;
  bool surface;
  std::optional<double> lift;
};

Shown shownAt(const GBuffer& gbuffer, const glm::ivec2& pixel) {
  const std::size_t n = gbuffer.pixels(), i = gbuffer.index(pixel.x, pixel.y);
  return {{gbuffer.position[i], gbuffer.position[i + n], gbuffer.position[i + 2 * n]},
          {gbuffer.normal[i], gbuffer.normal[i + n], gbuffer.normal[i + 2 * n]},
          std::isfinite(gbuffer.position[i + 2 * n]),
          gbuffer.lift.empty() ? std::nullopt : std::optional<double>(gbuffer.lift[i])};
}

double positionError(const Shown& shown, const SurfaceHit& hit) {
  return glm::distance(shown.position, hit.position) / glm::length(hit.position);
}

/// The angle between two unit normals, radians. Computed from the chord between them, because the cosine of a
/// small angle has lost its digits.
double normalError(const Shown& shown, const SurfaceHit& hit) {
  return 2 * std::asin(std::min(glm::distance(shown.normal, hit.normal) / 2, 1.0));
}

bool isSame(const Shown& shown, const SurfaceHit& hit) {
  return positionError(shown, hit) <= kSamePlace &&
         normalError(shown, hit) <= (hit.bent ? kSameBentNormal : kSameNormal);
}

/// Places around another at a distance of `radius` pixels.
std::array<glm::dvec2, 8> placesAround(const glm::dvec2& at, double radius) {
  std::array<glm::dvec2, 8> places;
  for (int i = 0; i < 8; ++i) {
    const double angle = i * std::numbers::pi / 4;
    places[i] = at + radius * glm::dvec2(std::cos(angle), std::sin(angle));
  }
  return places;
}

/// Whether a triangle ends within kEdgePixels of a place: at an edge, or where the near or far plane cuts it.
bool endsBeside(const Tracer& tracer, std::uint32_t triangle, const glm::dvec2& at, const glm::ivec2& pixel) {
  if (distanceToEdges(tracer, triangle, at) <= kEdgePixels) return true;
  const auto around = placesAround(at, kEdgePixels);
  return std::any_of(around.begin(), around.end(), [&](const glm::dvec2& place) {
    return !intersect(tracer, viewRay(tracer.plane, place), triangle, pixel);
  });
}

/// Whether the pixel's point lies on the edge of a triangle that the sample's ray misses: its projection is
/// within kEdgePixels of the sample, and a ray close to it hits the triangle.
bool isOnRimBeside(const Tracer& tracer, const Shown& shown, const std::vector<SurfaceHit>& hits,
                   const glm::dvec2& at, const glm::ivec2& pixel) {
  const double w = tracer.plane.perspective ? -shown.position.z : 1.0;
  const glm::dvec2 seen = (glm::dvec2(shown.position) / w - tracer.plane.offset) / tracer.plane.scale;
  if (glm::distance(seen, at) > kEdgePixels) return false;
  const auto passesBeside = [&](std::uint32_t triangle) {
    return std::none_of(hits.begin(), hits.end(),
                        [&](const SurfaceHit& hit) { return hit.triangle == triangle; });
  };
  for (const double radius : {kEdgePixels / 8, kEdgePixels}) {
    for (const glm::dvec2& around : placesAround(seen, radius)) {
      for (const SurfaceHit& hit : follow(tracer, around, pixel))
        if (passesBeside(hit.triangle) &&
            distanceToTriangle(cornersOf(tracer.geometry, hit.triangle), shown.position) <=
                kSamePlace * glm::length(shown.position))
          return true;
    }
  }
  return false;
}

/// Whether snapping explains that the pixel shows this surface instead of the first hit: all surfaces in
/// front of it have an edge near the sample, and so has the surface itself unless the ray hits it.
bool isBesideEdge(const Tracer& tracer, const Shown& shown, const std::vector<SurfaceHit>& hits,
                  const glm::dvec2& at, const glm::ivec2& pixel) {
  bool is_hit = !shown.surface;
  for (const SurfaceHit& hit : hits) {
    if (shown.surface && isSame(shown, hit)) is_hit = true;
    const bool in_front =
        !shown.surface || hit.depth < -shown.position.z - kSamePlace * glm::length(shown.position);
    if (in_front && !endsBeside(tracer, hit.triangle, at, pixel)) return false;
  }
  return is_hit || isOnRimBeside(tracer, shown, hits, at, pixel);
}

void checkPixel(const Tracer& tracer, const GBuffer& gbuffer, const glm::ivec2& in_crop,
                GBufferCheck& check) {
  const glm::ivec2 pixel = in_crop + gbuffer.crop_origin;
  const glm::dvec2 at(pixel);
  const Shown shown = shownAt(gbuffer, in_crop);
  const std::vector<SurfaceHit> hits = follow(tracer, at, pixel);
  ++check.pixels;
  if (hits.empty() && !shown.surface) return;
  for (const SurfaceHit& hit : hits) {
    if (!shown.surface || !isSame(shown, hit)) continue;
    if (hit.depth - hits.front().depth > kSamePlace * glm::length(hit.position)) break;
    if (&hit != &hits.front()) ++check.at_ties;
    if (distanceToEdges(tracer, hit.triangle, at) <= kEdgePixels) return;
    const double error = positionError(shown, hit);
    if (error > check.position_error && check.unexplained == 0) check.worst_pixel = pixel;
    check.position_error = std::max(check.position_error, error);
    double& normal_error = hit.bent ? check.bent_normal_error : check.normal_error;
    normal_error = std::max(normal_error, normalError(shown, hit));
    if (shown.lift && !hit.bent)
      check.lift_error =
          std::max(check.lift_error, std::abs(*shown.lift - hit.lift) / glm::length(hit.position));
    return;
  }
  if (isBesideEdge(tracer, shown, hits, at, pixel)) {
    ++check.beside_edges;
    return;
  }
  ++check.unexplained;
  check.worst_pixel = pixel;
}

GBufferCheck sum(const GBufferCheck& a, const GBufferCheck& b) {
  GBufferCheck both = a;
  both.pixels += b.pixels;
  both.beside_edges += b.beside_edges;
  both.at_ties += b.at_ties;
  both.unexplained += b.unexplained;
  const bool b_is_worse =
      (b.unexplained > 0) != (a.unexplained > 0) ? b.unexplained > 0 : b.position_error > a.position_error;
  if (b_is_worse) both.worst_pixel = b.worst_pixel;
  both.position_error = std::max(a.position_error, b.position_error);
  both.normal_error = std::max(a.normal_error, b.normal_error);
  both.bent_normal_error = std::max(a.bent_normal_error, b.bent_normal_error);
  both.lift_error = std::max(a.lift_error, b.lift_error);
  return both;
}

}  // namespace

GBufferCheck checkGBuffer(const Scene& scene, const View& view, const GBuffer& gbuffer,
                          std::span<const glm::ivec2> pixels) {
  const Tracer tracer = makeTracer(scene, view);
  return tbb::parallel_reduce(
      tbb::blocked_range<std::size_t>(0, pixels.size(), 256), GBufferCheck{},
      [&](const tbb::blocked_range<std::size_t>& range, GBufferCheck check) {
        for (std::size_t i = range.begin(); i < range.end(); ++i)
          checkPixel(tracer, gbuffer, pixels[i], check);
        return check;
      },
      sum);
}

}  // namespace luciole
