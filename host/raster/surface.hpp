#pragma once

#include <glm/glm.hpp>

#include "luciole/scene.hpp"
#include "raster/geometry.hpp"
#include "raster/view.hpp"

namespace luciole {

/// The rays of pixels, in view space. A perspective view looks from the origin along (x, y, −1), a parallel
/// one from (x, y, 0) along (0, 0, −1). (x, y) is an affine function of the pixel.
struct ViewPlane {
  bool perspective;
  glm::dvec2 scale;
  glm::dvec2 offset;

  /// (x, y, 1) for a pixel of the whole picture, or a place between two pixels' samples.
  glm::dvec3 at(double x, double y) const { return {offset + scale * glm::dvec2(x, y), 1.0}; }
};
/// The rays of a view's samples.
ViewPlane viewPlane(const View& view);

/// A triangle before clipping, in view space, in double, set up for interpolation. A pixel's ray intersects
/// the triangle's plane at corner + b1 · edge1 + b2 · edge2 with b = dot(weight row, p) / dot(determinant
/// row, p), p as in ViewPlane::at (Möller and Trumbore, "Fast, minimum storage ray/triangle intersection",
/// 1997, with the pixel factored out). Every row is built from edges, so that a small triangle far away keeps
/// its precision.
struct Surface {
  const PlacedObject* object = nullptr;
  const Material* material = nullptr;
  glm::uvec3 corners{0};  ///< indices into the mesh's vertices
  glm::dvec3 corner{0.0};
  glm::dvec3 edge1{0.0};
  glm::dvec3 edge2{0.0};
  glm::dvec3 weight1{0.0};
  glm::dvec3 weight2{0.0};
  glm::dvec3 determinant{0.0};
  glm::dvec3 normal{0.0};  ///< unit, on the front side; (0, 0, 1) where the triangle has no area
  bool front_facing = true;
  std::uint64_t blend_surface = 0;  ///< see blendSurface(); only where hasHoles()
};
/// Sets up a triangle by its number among those of the objects. The surface refers to `scene` and `objects`.
/// O(log objects).
Surface makeSurface(const Scene& scene, const std::vector<PlacedObject>& objects, std::uint32_t triangle,
                    const ViewPlane& plane);

/// Barycentric weights of a triangle's three corners.
using Weights = glm::dvec3;

/// Weights of the point where the ray of the pixel at `p` (see ViewPlane::at) intersects the triangle's
/// plane, inside the triangle or not. May be not finite for a triangle seen edge on.
inline Weights weightsInPlane(const Surface& surface, const glm::dvec3& p) {
  const double scale = 1.0 / glm::dot(surface.determinant, p);
  const double b1 = glm::dot(surface.weight1, p) * scale;
  const double b2 = glm::dot(surface.weight2, p) * scale;
  return {1.0 - b1 - b2, b1, b2};
}

/// The same, but inside the triangle: weights are ≥ 0, finite, and their sum is 1. Snapping lets a triangle
/// cover samples up to 1/256 pixel outside it. They show a point of its edge rather than one of its plane
/// beyond the edge.
Weights weightsInside(const Surface& surface, const glm::dvec3& p);

/// Texture coordinates at a point of a surface whose mesh has uvs.
glm::dvec2 interpolateUv(const Surface& surface, const Weights& weights);

/// Texture coordinates at a pixel, and their steps to the next pixel right and down (zero where not finite).
struct TexturePlace {
  glm::vec2 uv;
  glm::vec2 duv_dx;
  glm::vec2 duv_dy;
};
/// `x` and `y`: as in ViewPlane::at; `weights`: of the point that is seen there. The mesh must have uvs.
TexturePlace texturePlace(const Surface& surface, const ViewPlane& plane, double x, double y,
                          const Weights& weights);

/// A channel of a map at `place`, as by sampleTexture(); `map` must have a texture.
float lookUp(const Scene& scene, const TextureUse& map, const TexturePlace& place, int channel);

/// The tangent of a surface that a normal map bends, in view space on the front side: unit, or any vector
/// shorter than 1 where there is none; in w its side, ±1 (see Mesh::tangents).
glm::dvec4 tangentAt(const Surface& surface, const Weights& weights);

/// The vertex colour at a point; 1 where the mesh has none.
glm::vec4 vertexColor(const Surface& surface, const Weights& weights);

/// A per-vertex array's value at a point.
template <class T>
glm::dvec3 interpolate(const T* values, const glm::uvec3& corners, const Weights& weights) {
  return weights[0] * glm::dvec3(values[corners[0]]) + weights[1] * glm::dvec3(values[corners[1]]) +
         weights[2] * glm::dvec3(values[corners[2]]);
}

}  // namespace luciole
