#include "shade/points.hpp"

#include <algorithm>
#include <utility>

#include "gbuffer/tangent_plane.hpp"

namespace luciole {
namespace {

/// As many zeros as the largest group has that this program reads and the G-buffer lacks. hides_emission: as
/// if it lacked that.
Plane zerosFor(const GBuffer& gbuffer, const FeatureSet& compiled, bool hides_emission) {
  const PlaneSet read = neededPlanes(compiled);
  std::size_t planes = 0;
  const auto take = [&](bool is_read, const Plane& group, std::size_t group_planes) {
    if (is_read && group.empty()) planes = std::max(planes, group_planes);
  };
  take(read.specular, gbuffer.specular, 4);
  take(read.ambient, gbuffer.ambient, 3);
  // Light with bounds comes in the place of emission.
  take(read.emission && !compiled.lightError(), hides_emission ? Plane() : gbuffer.emission, 3);
  take(read.lift, gbuffer.lift, 1);
  return Plane(planes * gbuffer.pixels());
}

}  // namespace

Points pointsOnDevice(OpenedDevice& device, const GBuffer& gbuffer, const FeatureSet& features,
                      const FeatureSet& compiled, bool unlit) {
  const std::size_t stride = gbuffer.pixels();
  const bool asks_surfaces = compiled.shadowMaps() || compiled.has(Feature::kNormalMaps);
  const bool hides_emission = !features.has(Feature::kEmission);
  const bool hides_models = !features.has(Feature::kMaterialModels);
  PackedNormals packed;
  if (asks_surfaces && surfaceNormals(gbuffer).empty()) packed = packedNormals(gbuffer);
  ModelPlane default_model(
      compiled.has(Feature::kMaterialModels) && (gbuffer.model.empty() || hides_models) ? stride : 0);
  const PackedNormals& surface_normal = packed.empty() ? surfaceNormals(gbuffer) : packed;
  PackedNormals tangents;
  if (compiled.has(Feature::kTangents) && gbuffer.tangent.empty()) tangents = tangentsOf(gbuffer);
  const PackedNormals& tangent = tangents.empty() ? gbuffer.tangent : tangents;
  const ModelPlane& model = default_model.empty() ? gbuffer.model : default_model;
  GBufferBuffers buffers =
      borrowedGBuffer(device, gbuffer, surface_normal, gbuffer.lift, model, tangent, unlit);
  Plane zeros = zerosFor(gbuffer, compiled, hides_emission);
  if (!zeros.empty()) {
    const Buffer<const float> zero = borrowed(device, zeros);
    if (gbuffer.specular.empty()) buffers.specular = zero;
    if (gbuffer.ambient.empty() && !unlit) buffers.ambient = zero;
    if (gbuffer.emission.empty() || hides_emission) buffers.emission = zero;
    if (gbuffer.lift.empty()) buffers.lift = zero;
  }
  const std::size_t floats = gbuffer.position.size() + gbuffer.normal.size() + gbuffer.diffuse.size() +
                             gbuffer.specular.size() + gbuffer.ambient.size() + gbuffer.emission.size() +
                             surface_normal.size() + gbuffer.lift.size() + zeros.size() + model.size() +
                             tangent.size();
  return {gbuffer,          std::move(packed),        std::move(tangents),
          std::move(zeros), std::move(default_model), buffers,
          stride,           floats * sizeof(float)};
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
