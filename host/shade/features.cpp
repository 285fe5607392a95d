#include "shade/features.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kernels/shared.h"
#include "raster/lift.hpp"
#include "scene/count_triangles.hpp"
#include "scene/models.hpp"
#include "scene/tangents.hpp"
#include "shade/clustered_light.hpp"
#include "shade/sampled_light.hpp"
#include "shade/shadow_ways.hpp"
#include "shaders/shader_text.hpp"
#include "shadow/maps/shadow_views.hpp"

namespace luciole {

#define FEATURE_ROW(name, define, shown, meaning, uses) FeatureRow{#define, shown, meaning, uses},
#define MODEL_ROW(name, typed, shown, meaning, diffuse, specular) \
  FeatureRow{"k" #name "Model", shown, meaning, kForClusters | kForSampling},
const std::array<FeatureRow, kFeatureCount> kFeatureTable{{EACH_FEATURE(FEATURE_ROW, MODEL_ROW)}};
#undef MODEL_ROW
#undef FEATURE_ROW
static_assert(kFeatureCount < 64, "FEATURES is a number of 64 bits");

std::vector<std::string> featureNames(const FeatureSet& features) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < kFeatureCount; ++i)
    if (features.has(static_cast<Feature>(i))) names.push_back(kFeatureTable[i].name);
  return names;
}

SurfaceTraits materialTraits(const Scene& scene) {
  SurfaceTraits traits;
  traits.normal_maps = hasNormalMaps(scene);
  for (const Material& material : scene.materials) {
    traits.specular |= material.specular != glm::vec3(0.0f);
    traits.emission |= material.emission != glm::vec3(0.0f);
  }
  const bool shadows =
      std::any_of(scene.lights.begin(), scene.lights.end(), [](const Light& light) { return light.shadow; });
  traits.smooth = shadows && hasBentCorners(scene);
  traits.models = modelChoices(scene);
  return traits;
}

void chooseModel(const ModelChoices& choices, ShadeSettings& settings) {
  ModelChoices models = choices;  // with the picture's in the place of none
  if (models[0]) models.set(modelNumber(settings.model));
  models.reset(0);
  settings.material_models = models.count() > 1;
  for (std::uint32_t number = 1; number < models.size(); ++number)
    if (models.count() == 1 && models[number]) settings.model = modelOfNumber(number, {});
}

ShadowWay shadowWay(const Scene& scene, std::size_t light, const ShadeSettings& settings) {
  if (!scene.lights[light].shadow || settings.shadows == ShadowMethod::kOff) return ShadowWay::kNone;
  if (settings.shadows == ShadowMethod::kExact || settings.shadows == ShadowMethod::kSoftExact)
    return ShadowWay::kBeams;
  if (settings.shadows != ShadowMethod::kAuto) return ShadowWay::kMap;
  return settings.shadow_ways.empty() ? ShadowWay::kBeams : settings.shadow_ways[light];
}

static bool anyHoles(const Scene& scene) {
  return std::any_of(scene.materials.begin(), scene.materials.end(),
                     [](const Material& material) { return material.alpha_cutoff > 0; });
}

UseConditions useConditions(const ShadeSettings& settings) {
  return {settings.material_models ? std::nullopt : std::optional(settings.model), settings.shadows};
}

/// Whether sampling so many lights, all of this use, is estimated to be faster than to sum each, with beams
/// for its shadow.
static bool samplesAreFaster(const Scene& scene, const View& view, std::size_t lights, LightUse use,
                             const ShadeSettings& settings) {
  if (lights == 0) return false;
  const std::size_t casting = countCasting(scene.lights, use, useConditions(settings));
  // Summing a light at a point without its shadow.
  constexpr double kSum = 1.2e-6;
  const double points = double(view.size.x) * view.size.y, triangles = double(countTriangles(scene));
  const double one_by_one =
      double(lights) * kSum * points +
      double(casting) * beamMilliseconds({.points = points, .triangles = triangles}, anyHoles(scene));
  return sampledMilliseconds({lights, casting, points, triangles}, settings) < one_by_one;
}

StandIns standIns(const Scene& scene, const View& view, SurfaceTraits surfaces,
                  const ShadeSettings& settings) {
  if (!scene.lighting || !(settings.light_error > 0)) return {};
  const LightUseCounts counts = countUses(scene.lights, useConditions(settings));
  const std::size_t clustered = counts[std::size_t(LightUse::kClustered)],
                    sampled = counts[std::size_t(LightUse::kSampled)],
                    directions = counts[std::size_t(LightUse::kSampledDirection)];
  StandIns stand_ins{clustered > 0, sampled > 0, directions > 0};
  if (!settings.always_clusters) {
    stand_ins.clustered = clustersAreFaster({clustered, settings.light_error, surfaces.specular}, view);
    stand_ins.sampled = samplesAreFaster(scene, view, sampled, LightUse::kSampled, settings);
    stand_ins.directions = samplesAreFaster(scene, view, directions, LightUse::kSampledDirection, settings);
  }
  // Clusters know nothing of what stands behind a surface that a bent normal faces.
  stand_ins.clustered &= !surfaces.normal_maps;
  return stand_ins;
}

bool isSummed(LightUse use, const FeatureSet& features) {
  return !(use == LightUse::kClustered && features.has(Feature::kClusteredLights)) &&
         !(use == LightUse::kSampled && features.has(Feature::kSampledLights)) &&
         !(use == LightUse::kSampledDirection && features.has(Feature::kSampledDirections));
}

namespace {

void addFog(const Fog& fog, FeatureSet& features) {
  if (fog.mode == FogMode::kNone) return;
  features.set(fog.mode == FogMode::kLinear ? Feature::kFogLinear
               : fog.mode == FogMode::kExp  ? Feature::kFogExp
                                            : Feature::kFogExp2);
  const glm::vec3 density = fog.density;
  features.set(Feature::kFogRadial, fog.radial);
  features.set(Feature::kFogPerChannel,
               fog.mode != FogMode::kLinear && (density.x != density.y || density.x != density.z));
}

/// What the kernels need to sum this light, but for its shadow and its specular colour.
void addLight(const Light& light, FeatureSet& features) {
  features.set(light.kind == LightKind::kPoint         ? Feature::kPointLights
               : light.kind == LightKind::kDirectional ? Feature::kDirectionalLights
                                                       : Feature::kSpotLights);
  if (light.kind == LightKind::kSpot) {
    if (light.falloff == SpotFalloff::kCone) features.set(Feature::kSpotCone);
    if (light.exponent != 0) features.set(Feature::kSpotExponent);
  }
  if (light.kind != LightKind::kDirectional) {
    if (light.luminaire >= 0) features.set(Feature::kProfiles);
    if (light.attenuation != glm::vec3(1, 0, 0)) features.set(Feature::kAttenuation);
    if (std::isfinite(light.range))
      features.set(light.window == RangeWindow::kSmooth ? Feature::kSmoothWindow : Feature::kKhrWindow);
  }
  if (light.ambient != glm::vec3(0.0f)) features.set(Feature::kLightAmbient);
}

void addShadow(const Light& light, ShadowWay way, const ShadeSettings& settings, FeatureSet& features) {
  if (way == ShadowWay::kNone) return;
  features.set(way == ShadowWay::kBeams                ? Feature::kExact
               : usesCubeMap(light)                    ? Feature::kCubeShadows
               : light.kind == LightKind::kDirectional ? Feature::kParallelShadows
                                                       : Feature::kPerspectiveShadows);
  features.set(Feature::kPcf, settings.shadows == ShadowMethod::kPcf);
  features.set(Feature::kSoft, settings.shadows == ShadowMethod::kSoft);
  const double size = light.kind == LightKind::kDirectional ? light.half_angle : light.radius;
  if (settings.shadows == ShadowMethod::kSoftExact && size > 0) features.set(Feature::kSoftExact);
  features.set(Feature::kOutputShadow, settings.shadow_layer);
}

}  // namespace

FeatureSet neededFeatures(const Scene& scene, const Camera& camera, SurfaceTraits surfaces,
                          const ShadeSettings& settings, StandIns stand_ins) {
  FeatureSet features;
  features.set(Feature::kEmission, surfaces.emission);
  features.set(Feature::kParallelView, camera.orthographic);
  addFog(scene.fog, features);
  if (!scene.lighting) {
    features.set(Feature::kAmbient);  // unlit: diffuse colour under an ambient light of 1
    return features;
  }

  features.set(Feature::kClusteredLights, stand_ins.clustered);
  features.set(Feature::kSampledLights, stand_ins.sampled);
  features.set(Feature::kSampledDirections, stand_ins.directions);
  const UseConditions conditions = useConditions(settings);
  bool any_specular = false, clusters_specular = false, samples_specular = false, any_exponent = false,
       any_lobe = false, any_cell = false;
  std::size_t summed = 0;  // lights that are summed by themselves
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    const Light& light = scene.lights[i];
    const LightUse use = lightUse(light, conditions);
    const bool summed_alone = isSummed(use, features);
    (summed_alone                  ? any_specular
     : use == LightUse::kClustered ? clusters_specular
                                   : samples_specular) |= light.specular != glm::vec3(0.0f);
    any_cell |= light.cell > 0;
    any_lobe |= !summed_alone && light.kind == LightKind::kSpot;
    if (!summed_alone) continue;
    ++summed;
    addLight(light, features);
    addShadow(light, shadowWay(scene, i, settings), settings, features);
    any_exponent |= light.kind == LightKind::kSpot && light.falloff != SpotFalloff::kCone;
  }
  // A spot with an exponent of 0 needs no code of its own, unless cones are compiled: then the kernel has to
  // tell it from a cone at run time.
  if (features.has(Feature::kSpotCone) && any_exponent) features.set(Feature::kSpotExponent);
  features.set(Feature::kLightLists, settings.culling == Culling::kTiles && summed > 0);
  features.set(Feature::kLongSums, summed > kSumBlock);

  features.set(Feature::kLift, surfaces.smooth && (features.shadows() || features.sampledLight()));
  features.set(Feature::kNormalMaps, surfaces.normal_maps && !scene.lights.empty());
  features.set(Feature::kHoles, features.triangleTree() && anyHoles(scene));
  features.set(Feature::kAmbient, scene.ambient != glm::vec3(0.0f) || features.has(Feature::kLightAmbient));
  features.set(Feature::kSpecular, surfaces.specular && any_specular);

  const bool lit = !scene.lights.empty();
  if (!settings.material_models || surfaces.models[0]) features.set(featureOf(settings.model), lit);
  if (settings.material_models)
    for (std::uint32_t number = 1; number < surfaces.models.size(); ++number)
      if (surfaces.models[number]) features.set(featureOf(modelOfNumber(number, {})), lit);
  features.set(Feature::kMaterialModels, settings.material_models && lit);
  features.set(Feature::kTangents, features.has(Feature::kUserModels) && usesTangents(scene.user_models));

  // What clusters and samples give a pixel reaches the shading kernels as light that the surface emits.
  features.set(Feature::kClusteredHighlights, surfaces.specular && clusters_specular);
  features.set(Feature::kSampledHighlights, surfaces.specular && samples_specular);
  features.set(Feature::kSampledLobes, any_lobe);
  features.set(Feature::kWideHighlights, surfaces.specular && any_cell);
  if (features.lightError()) features.set(Feature::kEmission);
  return features;
}

FeatureSet featuresFor(FeatureUse use, const FeatureSet& features) {
  FeatureSet kept;
  for (std::size_t i = 0; i < kFeatureCount; ++i)
    kept.set(Feature(i), features.has(Feature(i)) && (kFeatureTable[i].uses & use) != 0);
  if (use == kForClusters)
    for (const Feature of_clusters : {Feature::kPointLights, Feature::kAttenuation}) kept.set(of_clusters);
  return kept;
}

FeatureSet generalFeatures() {
  // What `auto` and `exact` do in pictures without shadow maps, normal maps, holes and bounds of light.
  using enum Feature;
  FeatureSet general;
  // Ward's would cost every picture its machine code, and few ask for it.
  for (const Model model : kAllModels) general.set(featureOf(model), model != Model::kWard);
  for (const Feature feature :
       {kPointLights,  kDirectionalLights, kSpotLights,    kSpotExponent, kSpotCone,
        kAttenuation,  kSmoothWindow,      kKhrWindow,     kSpecular,     kAmbient,
        kLightAmbient, kEmission,          kExact,         kLift,         kFogLinear,
        kFogExp,       kFogExp2,           kFogPerChannel, kFogRadial,    kParallelView,
        kLightLists,   kLongSums,          kMaterialModels})
    general.set(feature);
  return general;
}

bool isGeneral(const FeatureSet& features) {
  // Without shadows many lights are shaded by tiles, which is another kernel.
  const bool by_tiles = features.has(Feature::kLongSums) && !features.shadows();
  return features.has(Feature::kLightLists) && !by_tiles &&
         features.without(generalFeatures()) == FeatureSet{};
}

PlaneSet neededPlanes(const FeatureSet& features) {
  return {.specular = features.has(Feature::kSpecular) || features.has(Feature::kClusteredHighlights) ||
                      features.has(Feature::kSampledHighlights) || features.has(Feature::kOrenNayar) ||
                      features.has(Feature::kUserModels),  // for the shininess
          .ambient = features.has(Feature::kAmbient),
          .emission = features.has(Feature::kEmission),
          .geometric_normal = features.shadowMaps() && !features.has(Feature::kNormalMaps),
          .unbent_normal = features.has(Feature::kNormalMaps),
          .lift = features.has(Feature::kLift),
          .model = features.has(Feature::kMaterialModels),
          .tangent = features.has(Feature::kTangents)};
}

std::string featureDefines(const FeatureSet& features) {
  return fmt::format("-DFEATURES=0x{:x}ul ", features.bits());
}

std::string userTextFor(const FeatureSet& features, const std::string& user_text) {
  return features.has(Feature::kUserModels) ? user_text : "";
}

std::string mathDefines(const ShadeSettings& settings) {
  return fmt::format("-DLOG2_DEGREE={} -DEXP2_DEGREE={} -DPCF_WIDTH={} ", settings.log2_degree,
                     settings.exp2_degree, settings.pcf_width);
}

}  // namespace luciole
