#include "shade/points.hpp"

#include <tbb/parallel_for.h>

#include <utility>

#include "gbuffer/packed_normal.hpp"

namespace luciole {
namespace {

PackedNormals packNormals(const GBuffer& gbuffer) {
  const std::size_t pixels = gbuffer.pixels();
  PackedNormals packed(pixels);
  tbb::parallel_for(std::size_t(0), pixels, [&](std::size_t i) {
    const glm::dvec3 normal(gbuffer.normal[i], gbuffer.normal[i + pixels], gbuffer.normal[i + 2 * pixels]);
    if (normal != glm::dvec3(0.0)) packed[i] = packNormal(normal);
  });
  return packed;
}

}  // namespace

Points pointsOnDevice(OpenedDevice& device, const GBuffer& gbuffer, const FeatureSet& features, bool unlit) {
  const std::size_t stride = gbuffer.pixels();
  const bool asks_surfaces = features.shadowMaps() || features.has(Feature::kNormalMaps);
  PackedNormals packed;
  if (asks_surfaces && surfaceNormals(gbuffer).empty()) packed = packNormals(gbuffer);
  Plane zero_lift(features.has(Feature::kLift) && gbuffer.lift.empty() ? stride : 0);
  ModelPlane default_model(features.has(Feature::kMaterialModels) && gbuffer.model.empty() ? stride : 0);
  const PackedNormals& surface_normal = packed.empty() ? surfaceNormals(gbuffer) : packed;
  const Plane& lift = zero_lift.empty() ? gbuffer.lift : zero_lift;
  const ModelPlane& model = default_model.empty() ? gbuffer.model : default_model;
  const GBufferBuffers buffers = borrowedGBuffer(device, gbuffer, surface_normal, lift, model, unlit);
  const std::size_t floats = gbuffer.position.size() + gbuffer.normal.size() + gbuffer.diffuse.size() +
                             gbuffer.specular.size() + gbuffer.ambient.size() + gbuffer.emission.size() +
                             surface_normal.size() + lift.size() + model.size();
  return {gbuffer, std::move(packed),     std::move(zero_lift), std::move(default_model), buffers,
          stride,  floats * sizeof(float)};
}

CullArguments cullArguments(const Points& points, const LightSet& lights, unsigned group_log2,
                            unsigned tests) {
  return {.position = points.buffers.position,
          .normal = points.buffers.normal,
          .plane_stride = points.stride,
          .group_log2 = group_log2,
          .lights = lights.light_buffer,
          .light_count = lights.lights.size(),
          .tree = lights.tree_buffer,
          .tree_stride = lights.tree.stride,
          .tests = tests};
}

}  // namespace luciole
