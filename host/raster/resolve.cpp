#include "raster/resolve.hpp"

#include <cmath>

#include "raster/planes.hpp"

namespace luciole {
namespace {

glm::vec3 normalAt(const Surface& surface, const Weights& weights, Shading shading) {
  glm::dvec3 normal = surface.normal;
  if (shading != Shading::kFlat) {
    const glm::dvec3 sum = surface.object->normal_to_view *
                           interpolate(surface.object->mesh->normals.data(), surface.corners, weights);
    const double length = glm::length(sum);
    if (length > 0.0 && std::isfinite(length)) normal = sum / length;
  }
  return glm::vec3(surface.front_facing ? normal : -normal);
}

/// What the maps and the vertex colours multiply into a surface's reflection and emission.
struct Tint {
  glm::vec3 reflection{1.0f};
  glm::vec3 emission{1.0f};
};

Tint tintAt(const ResolveInput& input, const Surface& surface, const Weights& weights, int x, int y) {
  Tint tint;
  const Material& material = *surface.material;
  const bool mapped = material.diffuse_map.texture >= 0 || material.emission_map.texture >= 0;
  if (mapped && !surface.object->mesh->uvs.empty()) {
    const TexturePlace place = texturePlace(surface, input.plane, x, y, weights);
    if (material.diffuse_map.texture >= 0)
      tint.reflection = glm::vec3(lookUp(input.scene, material.diffuse_map, place));
    if (material.emission_map.texture >= 0)
      tint.emission = glm::vec3(lookUp(input.scene, material.emission_map, place));
  }
  return tint;
}

void resolvePixel(const ResolveInput& input, const Surface& surface, int x, int y, std::size_t place,
                  GBuffer& gbuffer) {
  const std::size_t stride = gbuffer.pixels();
  const Material& material = *surface.material;
  const Weights weights = weightsInside(surface, input.plane.at(x, y));
  // From the first corner, so that the edges' digits count, not the distance's.
  storePixel(glm::vec3(surface.corner + weights[1] * surface.edge1 + weights[2] * surface.edge2), place,
             stride, gbuffer.position);
  storePixel(normalAt(surface, weights, input.shading), place, stride, gbuffer.normal);
  const Tint tint = tintAt(input, surface, weights, x, y);
  if (input.shading == Shading::kGouraud && !input.vertex_colors.empty()) {
    const glm::vec3* colors = input.vertex_colors.data() + surface.object->first_vertex;
    storePixel(glm::vec3(interpolate(colors, surface.corners, weights)) * tint.reflection, place, stride,
               gbuffer.emission);
    return;
  }
  const glm::vec3 reflection = tint.reflection * glm::vec3(vertexColor(surface, weights));
  storePixel(material.diffuse * reflection, place, stride, gbuffer.diffuse);
  if (!gbuffer.ambient.empty()) storePixel(material.ambient * reflection, place, stride, gbuffer.ambient);
  if (!gbuffer.emission.empty())
    storePixel(material.emission * tint.emission, place, stride, gbuffer.emission);
  if (!gbuffer.specular.empty()) {
    storePixel(material.specular, place, stride, gbuffer.specular);
    gbuffer.specular[3 * stride + place] = material.shininess;
  }
}

}  // namespace

void resolveBin(const ResolveInput& input, const BinPixels& pixels, glm::ivec2 bin_origin, GBuffer& gbuffer) {
  const glm::ivec2 first = glm::max(bin_origin, gbuffer.crop_origin);
  const glm::ivec2 end =
      glm::min(bin_origin + kBinSize, gbuffer.crop_origin + glm::ivec2(gbuffer.width, gbuffer.height));
  std::uint32_t current = kNoTriangle;
  Surface surface;
  for (int y = first.y; y < end.y; ++y) {
    for (int x = first.x; x < end.x; ++x) {
      const std::uint32_t triangle = pixels.triangle[(y - bin_origin.y) * kBinSize + (x - bin_origin.x)];
      if (triangle == kNoTriangle) continue;
      if (triangle != current) {
        surface = makeSurface(input.scene, input.geometry, triangle, input.plane);
        current = triangle;
      }
      resolvePixel(input, surface, x, y, gbuffer.index(x - gbuffer.crop_origin.x, y - gbuffer.crop_origin.y),
                   gbuffer);
    }
  }
}

}  // namespace luciole
