#include "render/aov_table.hpp"

#include "image/cryptomatte.hpp"

namespace luciole {
namespace {

/// Places of the components of a group of planes; nulls where there is no such group.
ChannelPlaces components(const FirstSample& sample, const Plane& group, std::size_t count) {
  ChannelPlaces places(count);
  for (std::size_t c = 0; c < count && !group.empty(); ++c)
    places[c] = group.data() + sample.gbuffer.pixels() * c;
  return places;
}

ChannelPlaces materialPlaces(const FirstSample& sample) {
  ChannelPlaces all = components(sample, sample.gbuffer.specular, 4);
  for (const Plane* group : {&sample.gbuffer.ambient, &sample.gbuffer.emission})
    for (const float* place : components(sample, *group, 3)) all.push_back(place);
  return all;
}

/// The visible share of shadowed lights; all of them where no light casts shadows.
ChannelPlaces shadowPlace(const FirstSample& sample) {
  const std::size_t n = sample.gbuffer.pixels();
  const bool has_shadows = sample.lit.color.size() == 4 * n;
  return {has_shadows ? sample.lit.color.data() + 3 * n : sample.all_visible.data()};
}

}  // namespace

const std::array<AovRow, kAovCount>& aovTable() {
  using Sample = const FirstSample&;
  static const std::array<AovRow, kAovCount> kTable{{
      {.aov = Aov::kPosition,
       .name = "position",
       .channels = {"P.X", "P.Y", "P.Z"},
       .places = [](Sample sample) { return components(sample, sample.world_position, 3); },
       .in_world = true},
      {.aov = Aov::kNormal,
       .name = "normal",
       .channels = {"N.X", "N.Y", "N.Z"},
       .places = [](Sample sample) { return components(sample, sample.world_normal, 3); },
       .in_world = true},
      {.aov = Aov::kDepth,
       .name = "depth",
       .channels = {"Z"},
       .places = [](Sample sample) { return components(sample, sample.depth, 1); },
       .in_world = true},
      {.aov = Aov::kDiffuse,
       .name = "diffuse",
       .channels = {"diffuse.R", "diffuse.G", "diffuse.B"},
       .places = [](Sample sample) { return components(sample, sample.gbuffer.diffuse, 3); }},
      {.aov = Aov::kMaterial,
       .name = "material",
       .channels = {"specular.R", "specular.G", "specular.B", "shininess", "ambient.R", "ambient.G",
                    "ambient.B", "emission.R", "emission.G", "emission.B"},
       .places = materialPlaces},
      {.aov = Aov::kAmbient, .name = "ambient"},
      {.aov = Aov::kDiffuseLight, .name = "diffuse_light"},
      {.aov = Aov::kSpecularLight, .name = "specular_light"},
      {.aov = Aov::kEmission, .name = "emission"},
      {.aov = Aov::kFog, .name = "fog"},
      {.aov = Aov::kObjectId, .name = "object_id", .channels = {"object_id"}, .otherwise = -1.0f},
      {.aov = Aov::kMaterialId, .name = "material_id", .channels = {"material_id"}, .otherwise = -1.0f},
      {.aov = Aov::kCryptoObject,
       .name = "cryptomatte_object",
       .channels = cryptomatteChannels(kCryptoObject)},
      {.aov = Aov::kCryptoMaterial,
       .name = "cryptomatte_material",
       .channels = cryptomatteChannels(kCryptoMaterial)},
      {.aov = Aov::kLightCount,
       .name = "light_count",
       .channels = {"light_count"},
       .places = [](Sample sample) { return components(sample, sample.lit.light_count, 1); }},
      {.aov = Aov::kListLength,
       .name = "list_length",
       .channels = {"list_length"},
       .places = [](Sample sample) { return components(sample, sample.lit.list_length, 1); }},
      {.aov = Aov::kShadow, .name = "shadow", .channels = {"shadow"}, .places = shadowPlace},
      {.aov = Aov::kLightError,
       .name = "light_error",
       .channels = {"light_error.R", "light_error.G", "light_error.B"}},
      {.aov = Aov::kShadingCount, .name = "shading_count", .channels = {"shading_count"}},
  }};
  return kTable;
}

}  // namespace luciole
