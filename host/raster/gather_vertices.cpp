#include <tbb/parallel_for.h>

#include <cmath>
#include <limits>

#include "gbuffer/packed_normal.hpp"
#include "gbuffer/tangent_plane.hpp"
#include "kernels/shared.h"
#include "luciole/planes.hpp"
#include "raster/empty_gbuffer.hpp"
#include "raster/geometry.hpp"
#include "raster/rasterize.hpp"

namespace luciole {
namespace {

/// For each vertex of an object, the material of the first triangle that uses it; null where none does.
std::vector<const Material*> vertexMaterials(const Scene& scene, const PlacedObject& object) {
  std::vector<const Material*> materials(object.mesh->positions.size());
  for (std::uint32_t i = 0; i < object.mesh->triangles.size(); ++i) {
    const glm::uvec3& corners = object.mesh->triangles[i];
    for (int corner = 0; corner < 3; ++corner) {
      const Material*& material = materials[corners[corner]];
      if (!material) material = &materialOf(scene, object, i);
    }
  }
  return materials;
}

void gatherVertex(const Scene& scene, const View& view, const PlacedObject& object, std::uint32_t vertex,
                  const Material& material, GBuffer& gbuffer) {
  const Mesh& mesh = *object.mesh;
  const glm::dvec3 position(object.object_to_view * glm::dvec4(mesh.positions[vertex], 1.0));
  const glm::dvec3 sum = object.normal_to_view * glm::dvec3(mesh.normals[vertex]);
  const double length = glm::length(sum);
  glm::dvec3 normal = length > 0.0 && std::isfinite(length) ? sum / length : glm::dvec3(0.0, 0.0, 1.0);
  if (material.double_sided && !eyeInFront(normal, position, isPerspective(view))) normal = -normal;
  const glm::vec3 color = mesh.colors.empty() ? glm::vec3(1.0f) : glm::vec3(mesh.colors[vertex]);

  const std::size_t place = object.first_vertex + vertex;
  const std::size_t stride = gbuffer.pixels();
  storePixel(glm::vec3(position), place, stride, gbuffer.position);
  storePixel(glm::vec3(normal), place, stride, gbuffer.normal);
  storePixel(material.diffuse * color, place, stride, gbuffer.diffuse);
  if (!gbuffer.ambient.empty()) storePixel(material.ambient * color, place, stride, gbuffer.ambient);
  const glm::vec3 glow = material.colored_emission ? material.emission * color : material.emission;
  if (!gbuffer.emission.empty()) storePixel(glow, place, stride, gbuffer.emission);
  // A vertex belongs to several triangles: its own normal stands for theirs.
  if (!gbuffer.geometric_normal.empty()) gbuffer.geometric_normal[place] = packNormal(normal);
  if (!gbuffer.unbent_normal.empty()) gbuffer.unbent_normal[place] = packNormal(normal);
  if (!gbuffer.model.empty()) gbuffer.model[place] = modelNumber(material.model);
  if (!gbuffer.tangent.empty()) {
    const glm::dvec3 along = mesh.tangents.empty() ? glm::dvec3(0.0) : glm::dvec3(mesh.tangents[vertex]);
    gbuffer.tangent[place] = packNormal(tangentOf(glm::dmat3(object.object_to_view) * along,
                                                  glm::dvec3(glm::vec3(normal)), view.world_to_view));
  }
  if (!gbuffer.uv.empty() && !mesh.uvs.empty())
    for (int c = 0; c < 2; ++c) gbuffer.uv[c * stride + place] = mesh.uvs[vertex][c];
  if (!gbuffer.object.empty()) gbuffer.object[place] = object.number;
  if (!gbuffer.material.empty()) gbuffer.material[place] = std::uint32_t(&material - scene.materials.data());
  if (!gbuffer.specular.empty()) {
    storePixel(material.specular, place, stride, gbuffer.specular);
    gbuffer.specular[3 * stride + place] = material.shininess;
  }
}

}  // namespace

GBuffer gatherVertices(const Scene& scene, std::span<const std::uint32_t> objects, const View& view,
                       PlaneSet planes) {
  const std::vector<PlacedObject> placed = placeObjects(scene, objects, view.world_to_view, true);
  const std::size_t vertices =
      placed.empty() ? 0 : placed.back().first_vertex + placed.back().mesh->positions.size();
  GBuffer gbuffer = emptyPoints(view, {int((vertices + kTilePixels - 1) / kTilePixels), 1}, planes);
  tbb::parallel_for(std::size_t(0), placed.size(), [&](std::size_t i) {
    const PlacedObject& object = placed[i];
    const std::vector<const Material*> materials = vertexMaterials(scene, object);
    for (std::uint32_t vertex = 0; vertex < materials.size(); ++vertex)
      if (materials[vertex]) gatherVertex(scene, view, object, vertex, *materials[vertex], gbuffer);
  });
  return gbuffer;
}

}  // namespace luciole
