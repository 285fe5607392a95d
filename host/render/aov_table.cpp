#include "render/aov_table.hpp"

#include <tbb/parallel_for.h>

#include <cmath>

#include "image/cryptomatte.hpp"

namespace luciole {
namespace {

/// The planes of a group's components; nulls if the group is empty.
PlanePointers components(const FirstSample& sample, const Plane& group, std::size_t count) {
  PlanePointers planes(count);
  for (std::size_t c = 0; c < count && !group.empty(); ++c)
    planes[c] = group.data() + sample.gbuffer.pixels() * c;
  return planes;
}

/// Computes planes of valueAt(place in the G-buffer), an array of kCount floats.
template <std::size_t kCount, class ValueAt>
PlanePointers compute(FirstSample& sample, const ValueAt& valueAt) {
  const std::size_t n = sample.gbuffer.pixels();
  Plane& group = sample.computed.emplace_back(kCount * n);
  tbb::parallel_for(std::size_t(0), n, [&](std::size_t i) {
    const std::array<float, kCount> value = valueAt(i);
    for (std::size_t c = 0; c < kCount; ++c) group[i + c * n] = value[c];
  });
  return components(sample, group, kCount);
}

glm::dvec3 vectorAt(const Plane& group, std::size_t i) {
  const std::size_t n = group.size() / 3;
  return {group[i], group[i + n], group[i + 2 * n]};
}

std::array<float, 3> floatsOf(const glm::dvec3& v) { return {float(v.x), float(v.y), float(v.z)}; }

/// World space; 0 for background.
PlanePointers positions(FirstSample& sample) {
  const GBuffer& gbuffer = sample.gbuffer;
  return compute<3>(sample, [&](std::size_t i) {
    const glm::dvec3 p = vectorAt(gbuffer.position, i);
    const glm::dvec3 world(gbuffer.camera.camera_to_world * glm::dvec4(p, 1));
    return floatsOf(std::isfinite(p.z) ? world : glm::dvec3(0));
  });
}

/// World space.
PlanePointers normals(FirstSample& sample) {
  const glm::dmat3 to_world(sample.gbuffer.camera.camera_to_world);
  return compute<3>(sample,
                    [&](std::size_t i) { return floatsOf(to_world * vectorAt(sample.gbuffer.normal, i)); });
}

/// Metres along the view axis.
PlanePointers depths(FirstSample& sample) {
  const float* z = sample.gbuffer.position.data() + 2 * sample.gbuffer.pixels();
  return compute<1>(sample, [&](std::size_t i) { return std::array{-z[i]}; });
}

PlanePointers materials(FirstSample& sample) {
  PlanePointers all = components(sample, sample.gbuffer.specular, 4);
  for (const Plane* group : {&sample.gbuffer.ambient, &sample.gbuffer.emission})
    for (const float* plane : components(sample, *group, 3)) all.push_back(plane);
  return all;
}

/// The mean visibility of lights that cast shadows; 1 if none does.
PlanePointers shadows(FirstSample& sample) {
  const std::size_t n = sample.gbuffer.pixels();
  if (sample.lit.color.size() == 4 * n) return {sample.lit.color.data() + 3 * n};
  return {sample.computed.emplace_back(n, 1.0f).data()};
}

/// The G-buffer's indices; -1 for background, and everywhere where it has none, until they are filled in.
PlanePointers ids(FirstSample& sample, const IndexPlane& indices) {
  return compute<1>(sample, [&](std::size_t i) {
    return std::array{indices.empty() || indices[i] == kNoIndex ? -1.0f : float(indices[i])};
  });
}

}  // namespace

const std::array<AovRow, kAovCount>& aovTable() {
  static const std::array<AovRow, kAovCount> kTable{{
      {.aov = Aov::kPosition,
       .name = "position",
       .channels = {"P.X", "P.Y", "P.Z"},
       .planes = positions,
       .computed_floats = 3},
      {.aov = Aov::kNormal,
       .name = "normal",
       .channels = {"N.X", "N.Y", "N.Z"},
       .planes = normals,
       .computed_floats = 3},
      {.aov = Aov::kDepth, .name = "depth", .channels = {"Z"}, .planes = depths, .computed_floats = 1},
      {.aov = Aov::kDiffuse,
       .name = "diffuse",
       .channels = {"diffuse.R", "diffuse.G", "diffuse.B"},
       .planes = [](FirstSample& sample) { return components(sample, sample.gbuffer.diffuse, 3); }},
      {.aov = Aov::kMaterial,
       .name = "material",
       .channels = {"specular.R", "specular.G", "specular.B", "shininess", "ambient.R", "ambient.G",
                    "ambient.B", "emission.R", "emission.G", "emission.B"},
       .planes = materials},
      {.aov = Aov::kAmbient, .name = "ambient"},
      {.aov = Aov::kDiffuseLight, .name = "diffuse_light"},
      {.aov = Aov::kSpecularLight, .name = "specular_light"},
      {.aov = Aov::kEmission, .name = "emission"},
      {.aov = Aov::kFog, .name = "fog"},
      {.aov = Aov::kIlluminance, .name = "illuminance"},
      {.aov = Aov::kObjectId,
       .name = "object_id",
       .channels = {"object_id"},
       .planes = [](FirstSample& sample) { return ids(sample, sample.gbuffer.object); },
       .computed_floats = 1},
      {.aov = Aov::kMaterialId,
       .name = "material_id",
       .channels = {"material_id"},
       .planes = [](FirstSample& sample) { return ids(sample, sample.gbuffer.material); },
       .computed_floats = 1},
      {.aov = Aov::kCryptoObject,
       .name = "cryptomatte_object",
       .channels = cryptomatteChannels(kCryptoObject)},
      {.aov = Aov::kCryptoMaterial,
       .name = "cryptomatte_material",
       .channels = cryptomatteChannels(kCryptoMaterial)},
      {.aov = Aov::kLightCount,
       .name = "light_count",
       .channels = {"light_count"},
       .planes = [](FirstSample& sample) { return components(sample, sample.lit.light_count, 1); }},
      {.aov = Aov::kListLength,
       .name = "list_length",
       .channels = {"list_length"},
       .planes = [](FirstSample& sample) { return components(sample, sample.lit.list_length, 1); }},
      {.aov = Aov::kShadow,
       .name = "shadow",
       .channels = {"shadow"},
       .planes = shadows,
       .computed_floats = 1},
      {.aov = Aov::kLightError,
       .name = "light_error",
       .channels = {"light_error.R", "light_error.G", "light_error.B"}},
      {.aov = Aov::kLightProof,
       .name = "light_proof",
       .channels = {"light_proof.R", "light_proof.G", "light_proof.B"},
       .initial = 1.0f},
      {.aov = Aov::kShadingCount, .name = "shading_count", .channels = {"shading_count"}},
  }};
  return kTable;
}

}  // namespace luciole
