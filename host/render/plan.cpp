#include "render/plan.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "render/memory.hpp"
#include "render/screens.hpp"
#include "shade/shadow_ways.hpp"
#include "shaders/shader_text.hpp"

namespace luciole {
namespace {

/// Features of the pass that lights vertices for Gouraud shading. Fog is left to pixels.
FeatureSet vertexFeatures(const FeatureSet& features) {
  FeatureSet kept = features.without(featuresFor(kForFog, features));
  kept.set(Feature::kOutputShadow, false);
  // A vertex lies on the smooth surface already.
  kept.set(Feature::kLift, false);
  return kept;
}

/// Features of the pass that only applies fog, to lit colours in the emission planes.
FeatureSet fogFeatures(const FeatureSet& features) {
  FeatureSet kept = featuresFor(kForFog, features);
  kept.set(Feature::kEmission);
  return kept;
}

/// The traits of a scene's surfaces that this shading uses.
SurfaceTraits surfaceTraits(const Scene& scene, Shading shading) {
  SurfaceTraits surfaces = materialTraits(scene);
  surfaces.smooth &= shading != Shading::kFlat;
  surfaces.normal_maps &= shading == Shading::kPhong;
  return surfaces;
}

/// The models that a G-buffer's surfaces choose.
ModelChoices modelsOf(const GBuffer& gbuffer) {
  ModelChoices choices;
  if (gbuffer.model.empty()) choices.set(0);
  for (std::size_t i = 0; i < gbuffer.model.size(); ++i)
    if (std::isfinite(gbuffer.position[i + 2 * gbuffer.pixels()])) choices.set(gbuffer.model[i]);
  return choices;
}

bool hasSpecular(const GBuffer& gbuffer) {
  const auto colors = std::ptrdiff_t(gbuffer.specular.empty() ? 0 : 3 * gbuffer.pixels());
  return std::any_of(gbuffer.specular.begin(), gbuffer.specular.begin() + colors,
                     [](float color) { return color > 0; });
}

SurfaceTraits surfaceTraits(const GBuffer& gbuffer) {
  return {hasSpecular(gbuffer), !gbuffer.emission.empty(), !gbuffer.lift.empty(),
          !gbuffer.unbent_normal.empty(), modelsOf(gbuffer)};
}

/// For each light whether it casts a shadow and isn't sampled.
std::vector<bool> summedCasters(const Scene& scene, const ShadeSettings& settings,
                                const StandIns& stand_ins) {
  const UseConditions conditions = useConditions(settings);
  std::vector<bool> casts(scene.lights.size());
  for (std::size_t i = 0; i < casts.size(); ++i) {
    const Light& light = scene.lights[i];
    const LightUse use = lightUse(light, conditions);
    casts[i] = light.shadow && !(stand_ins.sampled && use == LightUse::kSampled) &&
               !(stand_ins.directions && use == LightUse::kSampledDirection);
  }
  return casts;
}

/// The work of lighting so many points: pairs of a point and a light, of which 10^8 take 0.1 s. Of lights
/// with ranges few reach a point. Infinite where light has bounds, or lights a size.
double pairsOf(const Scene& scene, const FeatureSet& features, double points) {
  if (features.lightError() || features.has(Feature::kSoftExact))
    return std::numeric_limits<double>::infinity();
  constexpr double kMostInRange = 64;
  const auto ranged = std::count_if(scene.lights.begin(), scene.lights.end(),
                                    [](const Light& light) { return std::isfinite(light.range); });
  const double unbounded = double(scene.lights.size()) - double(ranged);
  return points * (1 + unbounded + std::min(double(ranged), kMostInRange));
}

/// The screens of the settings. Throws InputError.
std::vector<ScreenProgram> screenPrograms(const std::vector<Shader>& screens) {
  std::vector<ScreenProgram> programs;
  for (const Shader& shader : screens)
    programs.push_back({shader, shaderFacts(shader, ShaderKind::kScreen).radius});
  return programs;
}

/// The part of a plan that is the same for a scene's picture and for a G-buffer. view: of the whole picture.
/// points_a_pixel: see shadowWays.
PicturePlan planLight(const Scene& scene, const RenderSettings& settings, const SurfaceTraits& surfaces,
                      const Camera& camera, const View& view, double points_a_pixel) {
  PicturePlan plan;
  plan.shade = settings.shade;
  plan.shade.shadow_layer = settings.wants(Aov::kShadow);
  chooseModel(surfaces.models, plan.shade);
  plan.shade.user_text = shaderProgram(scene.user_models, ShaderKind::kModel);
  plan.layers = lightLayers(scene, settings);
  plan.screens = screenPrograms(settings.screens);
  const StandIns stand_ins = standIns(scene, view, surfaces, plan.shade);
  if (plan.shade.shadows == ShadowMethod::kAuto && plan.shade.shadow_ways.empty() && scene.lighting)
    plan.shade.shadow_ways = shadowWays(scene, view, points_a_pixel, plan.shade.shadow_limits,
                                        summedCasters(scene, plan.shade, stand_ins));
  plan.features = neededFeatures(scene, camera, surfaces, plan.shade, stand_ins);
  plan.pixels = plan.features;
  plan.pairs = pairsOf(scene, plan.features, double(view.size.x) * view.size.y * points_a_pixel);
  return plan;
}

void addProgram(const FeatureSet& features, std::vector<FeatureSet>& programs) {
  if (std::find(programs.begin(), programs.end(), features) == programs.end()) programs.push_back(features);
}

void addLayersPrograms(PicturePlan& plan) {
  for (const LightLayer& layer : plan.layers) addProgram(layerFeatures(plan.pixels, layer), plan.programs);
}

}  // namespace

PicturePlan planPicture(const Scene& scene, const RenderSettings& settings) {
  const SurfaceProgram program = surfaceProgram(settings.surfaces);
  SurfaceTraits surfaces = surfaceTraits(scene, settings.shading);
  surfaces.specular |= program.changes(kSpecularGroup);
  surfaces.emission |= program.changes(kEmissionGroup);
  surfaces.normal_maps |= program.changes(kNormalGroup);
  const bool shares_samples = sharesSamples(settings);
  PicturePlan plan =
      planLight(scene, settings, surfaces, settings.camera, cameraView(settings.camera, settings.size),
                shadedPoints(scene, settings.size, settings.samples, shares_samples));
  plan.view = cameraView(settings.camera, settings.size, settings.crop);
  plan.shares_samples = shares_samples;
  if (settings.shading == Shading::kGouraud) {
    plan.pixels = fogFeatures(plan.features);
    plan.vertices = vertexFeatures(plan.features);
  }
  plan.planes = neededPlanes(plan.pixels);
  // The light of clusters has planes of its own.
  if (plan.pixels.lightError()) plan.planes.emission = surfaces.emission;
  if (!scene.lighting) plan.planes.ambient = false;  // diffuse takes its place
  if (settings.wants(Aov::kMaterial))
    plan.planes.specular = plan.planes.ambient = plan.planes.emission = true;
  const ScreenGroups groups = groupsOf(plan.screens);
  plan.planes.object |= groups.object;
  plan.planes.material |= groups.material;
  // Objects that fog hides aren't in the G-buffer, and Cryptomattes need all samples.
  plan.ids_of_gbuffer = settings.samples == 1 && scene.fog.mode == FogMode::kNone &&
                        !settings.wants(Aov::kCryptoObject) && !settings.wants(Aov::kCryptoMaterial);
  plan.planes.object |= plan.ids_of_gbuffer && settings.wants(Aov::kObjectId);
  plan.planes.material |= plan.ids_of_gbuffer && settings.wants(Aov::kMaterialId);
  plan.surface = program;
  if (settings.shading != Shading::kGouraud) addGroups(program, plan.planes);
  addProgram(plan.pixels, plan.programs);
  if (settings.shading == Shading::kGouraud) addProgram(plan.vertices, plan.programs);
  addLayersPrograms(plan);
  plan.pixel_bytes = bytesPerPixel(scene, settings, plan);
  plan.band_height =
      settings.band_height > 0 ? settings.band_height : bandHeight(plan.view.crop_size, plan.pixel_bytes);
  return plan;
}

PicturePlan planShading(const Scene& scene, const GBuffer& gbuffer, const RenderSettings& settings) {
  const View view = cameraView(gbuffer.camera, gbuffer.picture_size, {}, gbuffer.display.pixel_aspect);
  PicturePlan plan = planLight(scene, settings, surfaceTraits(gbuffer), gbuffer.camera, view,
                               shadedPoints(scene, gbuffer.picture_size, 1, false));
  plan.view = view;
  addProgram(plan.pixels, plan.programs);
  addLayersPrograms(plan);
  return plan;
}

}  // namespace luciole
