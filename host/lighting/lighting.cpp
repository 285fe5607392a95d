#include "lighting/lighting.hpp"

#include <vector>

#include "lighting/bounded_lights.hpp"
#include "lights/light_use.hpp"
#include "lights/luminaires.hpp"

namespace luciole {
namespace {

float4 color4(const glm::vec3& color) { return {color.x, color.y, color.z, 0}; }

ShadeFrame makeFrame(const Scene& scene, const Camera& camera, const ShadeSettings& settings) {
  ShadeFrame frame{};
  frame.ambient = color4(scene.lighting ? scene.ambient : glm::vec3(1.0f));
  if (!environmentOf(scene)) frame.background = color4(scene.background);
  frame.fog_color = color4(scene.fog.color);
  frame.fog_density = color4(scene.fog.density);
  frame.eye = camera.orthographic ? float4{0, 0, 1, 0} : float4{0, 0, 0, 1};
  frame.fog_end = scene.fog.end;
  frame.fog_scale = 1.0f / (scene.fog.end - scene.fog.start);
  frame.fog_mode = static_cast<uint>(scene.fog.mode);
  frame.fog_radial = scene.fog.radial;
  frame.model = static_cast<uint>(settings.model);
  return frame;
}
static_assert(int(FogMode::kLinear) == kFogLinear && int(FogMode::kExp) == kFogExp &&
              int(FogMode::kExp2) == kFogExp2);

/// Fills in the picture's lights. Shadow maps are planned.
void prepareLightSet(OpenedDevice& device, const Scene& scene, const Camera& camera,
                     const ShadeSettings& settings, const Lighting& lighting, LightSet& set) {
  if (scene.lighting) {
    const FeatureSet& features = lighting.features;
    setBoundedLights(scene, camera, lighting.beams, features, boundedLights(scene, features, settings), {},
                     set);
    if (set.clusters.lights + set.samples.lights + set.directions.lights < scene.lights.size())
      set.order = spatialOrder(scene.lights);
    if (features.lightError())
      std::erase_if(set.order, [&](std::uint32_t light) {
        return !isSummed(lightUse(scene.lights[light], useConditions(settings)), features);
      });
    set.lights = prepareLights(scene, set.order, camera, lighting.maps.host.map_of_light);
    if (features.has(Feature::kProfiles))
      set.luminaires = setLuminaires(scene, camera, set.order, set.lights);
    if (lighting.features.has(Feature::kExact))
      for (std::size_t i = 0; i < set.order.size(); ++i) {
        const bool casts = shadowWay(scene, set.order[i], settings) == ShadowWay::kBeams;
        set.beam_lights.push_back(beamLight(scene.lights[set.order[i]], casts, lighting.beams));
        set.beam_lights.back().number = set.order[i];
        if (casts) set.lights[i].shadow = kExactShadow;
      }
  }
  finishLightSet(device, set);
}

}  // namespace

void prepareLighting(OpenedDevice& device, const Scene& scene, const Camera& camera, const View& view,
                     const FeatureSet& features, const ShadeSettings& settings, Lighting& lighting,
                     Stats& stats, KeptShadows* kept) {
  KeptShadows none;
  if (!kept) kept = &none;
  lighting.features = features;
  lighting.math_defines = mathDefines(settings);
  lighting.user_text = settings.user_text;
  lighting.unlit = !scene.lighting;
  lighting.lights.frame = makeFrame(scene, camera, settings);
  lighting.lights.sky = environmentOf(scene);
  lighting.group_log2 = groupLog2(settings.tile_size);
  lighting.samples = {.light_error = settings.light_error,
                      .least_value = settings.light_error_floor,
                      .deviations = deviationsOf(settings.confidence),
                      .seed = settings.seed,
                      .to_pixel = pixelsOf(view)};
  if (features.shadowMaps())
    timed(stats, Stage::kShadowMaps, [&] {
      lighting.maps.host =
          planShadowMaps(scene, view, settings.shadows, settings.shadow_limits, settings.shadow_ways);
      takeMaps(scene, *kept, lighting.maps.host);
    });
  if (features.triangleTree())
    timed(stats, Stage::kTriangleTree, [&] {
      updateTree(scene, glm::dvec3(camera.camera_to_world[3]), features.has(Feature::kHoles), *kept);
    });
  timed(stats, Stage::kWaitForDevice, [&] { awaitDevice(device); });
  timed(stats, Stage::kPrepareLights, [&] {
    if (features.triangleTree())
      prepareBeams(device, camera, kept->tree, features.has(Feature::kHoles) ? kept->masks : nullptr,
                   features.has(Feature::kSoftExact) ? settings.soft_samples : 0, lighting.beams);
    prepareLightSet(device, scene, camera, settings, lighting, lighting.lights);
    borrowMaps(device, lighting.maps);
  });
}

}  // namespace luciole
