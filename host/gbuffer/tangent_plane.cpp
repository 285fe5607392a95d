#include "gbuffer/tangent_plane.hpp"

#include <tbb/parallel_for.h>

#include <cmath>

#include "gbuffer/packed_normal.hpp"

namespace luciole {

PackedNormals packedNormals(const GBuffer& gbuffer) {
  const std::size_t pixels = gbuffer.pixels();
  PackedNormals packed(pixels);
  tbb::parallel_for(std::size_t(0), pixels, [&](std::size_t i) {
    const glm::dvec3 normal(gbuffer.normal[i], gbuffer.normal[i + pixels], gbuffer.normal[i + 2 * pixels]);
    if (normal != glm::dvec3(0.0)) packed[i] = packNormal(normal);
  });
  return packed;
}

PackedNormals tangentsOf(const GBuffer& gbuffer) {
  const std::size_t pixels = gbuffer.pixels();
  const glm::dmat3 world_to_view = glm::transpose(glm::dmat3(gbuffer.camera.camera_to_world));
  PackedNormals tangents(pixels);
  tbb::parallel_for(std::size_t(0), pixels, [&](std::size_t i) {
    if (std::isinf(gbuffer.position[i + 2 * pixels])) return;
    const glm::dvec3 normal(gbuffer.normal[i], gbuffer.normal[i + pixels], gbuffer.normal[i + 2 * pixels]);
    if (normal != glm::dvec3(0.0)) tangents[i] = packNormal(tangentOf({}, normal, world_to_view));
  });
  return tangents;
}

}  // namespace luciole
