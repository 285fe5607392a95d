#include "raster/surface.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "raster/blend.hpp"
#include "raster/opacity.hpp"
#include "raster/sample_texture.hpp"

namespace luciole {
namespace {

/// The row r for which dot(r, p) is dot(d, v), where d is the direction of the pixel at p (see ViewPlane). In
/// a perspective view v is constant. In a parallel view it depends on the ray's origin (x, y), so that d·v =
/// d·v0 + slope·(x, y).
glm::dvec3 row(const glm::dvec3& v, const glm::dvec2& slope, bool perspective) {
  return perspective ? glm::dvec3(v.x, v.y, -v.z) : glm::dvec3(slope, -v.z);
}

bool isInside(const Weights& weights) { return weights[0] >= 0.0 && weights[1] >= 0.0 && weights[2] >= 0.0; }

/// For a place p outside the triangle: the nearest place on the line of the edge that p is farthest beyond.
/// On an edge's line the weight of the opposite corner is 0.
glm::dvec3 nearestOnEdge(const Surface& surface, const glm::dvec3& p) {
  const std::array<glm::dvec3, 3> rows{surface.determinant - surface.weight1 - surface.weight2,
                                       surface.weight1, surface.weight2};
  const double side = glm::dot(surface.determinant, p) < 0.0 ? -1.0 : 1.0;
  double farthest = 0.0;
  glm::dvec2 step(0.0);
  for (const glm::dvec3& row : rows) {
    const glm::dvec2 across(row);
    const double length = glm::length(across);
    const double outside = -side * glm::dot(row, p) / length;
    if (!(outside > farthest)) continue;
    farthest = outside;
    step = across * (side * outside / length);
  }
  return p + glm::dvec3(step, 0.0);
}

glm::vec2 finiteOrZero(const glm::dvec2& step) {
  const glm::vec2 rounded(step);
  return std::isfinite(rounded.x) && std::isfinite(rounded.y) ? rounded : glm::vec2(0.0f);
}

/// A triangle's number in its mesh, or for the two of a quad, one behind the other, that of the first.
std::uint32_t triangleOrQuad(const Mesh& mesh, std::uint32_t triangle) {
  const std::uint32_t other = triangle ^ 1u;
  if (other >= mesh.triangles.size()) return triangle;
  const glm::uvec3 &a = mesh.triangles[triangle], &b = mesh.triangles[other];
  int common = 0;
  for (int i = 0; i < 3; ++i) common += a[i] == b[0] || a[i] == b[1] || a[i] == b[2];
  return common == 2 ? triangle & ~1u : triangle;
}

}  // namespace

ViewPlane viewPlane(const View& view) {
  const glm::dmat4& projection = view.projection;
  ViewPlane plane;
  plane.perspective = isPerspective(view);
  const glm::dvec2 focus(projection[0][0], projection[1][1]);
  const glm::dvec2 shift = plane.perspective ? glm::dvec2(projection[2]) : -glm::dvec2(projection[3]);
  // Normalized device coordinates are −1 + 2 · pixel / width, and 1 − 2 · pixel / height, since rows count
  // downwards.
  const glm::dvec2 step = glm::dvec2(2.0, -2.0) / glm::dvec2(view.size);
  plane.scale = step / focus;
  plane.offset = (glm::dvec2(-1.0, 1.0) + step * view.sample + shift) / focus;
  return plane;
}

Surface makeSurface(const Scene& scene, const std::vector<PlacedObject>& objects, std::uint32_t triangle,
                    const ViewPlane& plane) {
  Surface surface;
  const PlacedObject& object = objectOfTriangle(objects, triangle);
  const std::uint32_t in_mesh = triangle - object.first_triangle;
  surface.object = &object;
  surface.material = &materialOf(scene, object, in_mesh);
  surface.corners = object.mesh->triangles[in_mesh];
  const auto position = [&](int i) {
    return glm::dvec3(object.object_to_view * glm::dvec4(object.mesh->positions[surface.corners[i]], 1.0));
  };
  const glm::dvec3 a = position(0);
  const glm::dvec3 edge1 = position(1) - a;
  const glm::dvec3 edge2 = position(2) - a;
  const glm::dvec3 cross = glm::cross(edge1, edge2);
  surface.corner = a;
  surface.edge1 = edge1;
  surface.edge2 = edge2;
  surface.weight1 = row(glm::cross(edge2, a), {-edge2.y, edge2.x}, plane.perspective);
  surface.weight2 = row(glm::cross(a, edge1), {edge1.y, -edge1.x}, plane.perspective);
  surface.determinant = row(cross, {0.0, 0.0}, plane.perspective);
  surface.front_facing = eyeInFront(cross, a, plane.perspective) != object.mirrored;
  if (hasHoles(*surface.material))
    surface.blend_surface =
        blendSurface(object.number, triangleOrQuad(*object.mesh, in_mesh), surface.front_facing);
  const double length = glm::length(cross);
  surface.normal = length > 0.0 && std::isfinite(length) ? cross / (object.mirrored ? -length : length)
                                                         : glm::dvec3(0.0, 0.0, 1.0);
  return surface;
}

Weights weightsInside(const Surface& surface, const glm::dvec3& p) {
  Weights weights = weightsInPlane(surface, p);
  if (isInside(weights)) return weights;
  weights = weightsInPlane(surface, nearestOnEdge(surface, p));
  // Beyond a corner the weights are still outside the triangle, and on an edge they may be so by rounding. A
  // triangle seen edge on may have no finite weights; then its centre stands for it.
  for (int i = 0; i < 3; ++i) weights[i] = std::clamp(weights[i], 0.0, 1.0);
  const double sum = weights[0] + weights[1] + weights[2];
  return sum > 0.0 ? weights / sum : Weights(1.0 / 3.0);
}

glm::dvec2 interpolateUv(const Surface& surface, const Weights& weights) {
  const std::vector<glm::vec2>& uvs = surface.object->mesh->uvs;
  return weights[0] * glm::dvec2(uvs[surface.corners[0]]) + weights[1] * glm::dvec2(uvs[surface.corners[1]]) +
         weights[2] * glm::dvec2(uvs[surface.corners[2]]);
}

TexturePlace texturePlace(const Surface& surface, const ViewPlane& plane, double x, double y,
                          const Weights& weights) {
  const glm::dvec2 here = interpolateUv(surface, weightsInPlane(surface, plane.at(x, y)));
  const glm::dvec2 right = interpolateUv(surface, weightsInPlane(surface, plane.at(x + 1, y)));
  const glm::dvec2 below = interpolateUv(surface, weightsInPlane(surface, plane.at(x, y + 1)));
  return {glm::vec2(interpolateUv(surface, weights)), finiteOrZero(right - here), finiteOrZero(below - here)};
}

float lookUp(const Scene& scene, const TextureUse& map, const TexturePlace& place, int channel) {
  return sampleTexture(scene.textures[map.texture], map, place.uv, place.duv_dx, place.duv_dy, channel);
}

glm::dvec4 tangentAt(const Surface& surface, const Weights& weights) {
  const std::vector<glm::vec4>& tangents = surface.object->mesh->tangents;
  const glm::dvec4 mean = weights[0] * glm::dvec4(tangents[surface.corners[0]]) +
                          weights[1] * glm::dvec4(tangents[surface.corners[1]]) +
                          weights[2] * glm::dvec4(tangents[surface.corners[2]]);
  const glm::dvec3 tangent = glm::dmat3(surface.object->object_to_view) * glm::dvec3(mean);
  const double length = glm::length(tangent);
  const double side = (mean.w < 0.0) != surface.object->mirrored ? -1.0 : 1.0;
  return {length > 0.0 && std::isfinite(length) ? tangent / length : glm::dvec3(0.0), side};
}

glm::vec4 vertexColor(const Surface& surface, const Weights& weights) {
  const std::vector<glm::vec4>& colors = surface.object->mesh->colors;
  if (colors.empty()) return glm::vec4(1.0f);
  return float(weights[0]) * colors[surface.corners[0]] + float(weights[1]) * colors[surface.corners[1]] +
         float(weights[2]) * colors[surface.corners[2]];
}

}  // namespace luciole
