#include "shade/features.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bitset>

#include "base/embedded_files.hpp"
#include "kernels/probe.hpp"
#include "kernels/random_scene.hpp"
#include "lighting/light_gbuffer.hpp"
#include "luciole/load_scene.hpp"
#include "scene/models.hpp"
#include "shared_files.hpp"

namespace luciole::test {
namespace {

/// Features that mean nothing without another.
struct Needs {
  Feature feature;
  std::vector<Feature> any_of;  ///< the first is added where none is there
};

const std::vector<Needs>& needs() {
  using enum Feature;
  static const std::vector<Needs> rules{
      {kSpotExponent, {kSpotLights}},
      {kSpotCone, {kSpotLights}},
      {kAttenuation, {kPointLights, kSpotLights}},
      {kSmoothWindow, {kPointLights, kSpotLights}},
      {kKhrWindow, {kSpotLights, kPointLights}},
      {kMaterialModels, {kDirectionalLights, kPointLights, kSpotLights}},
      {kTangents, {kPointLights, kSpotLights, kDirectionalLights}},
      {kPointLights, {kPhong, kBlinnPhong, kToon, kCookTorrance, kOrenNayar, kWard}},
      {kDirectionalLights, {kCookTorrance, kToon, kWard, kOrenNayar, kBlinnPhong, kPhong}},
      {kSpotLights, {kToon, kPhong, kOrenNayar, kCookTorrance, kWard, kBlinnPhong}},
      {kSpecular, {kPointLights, kDirectionalLights, kSpotLights}},
      {kLightAmbient, {kAmbient}},
      {kLightAmbient, {kSpotLights, kPointLights, kDirectionalLights}},
      {kPcf, {kParallelShadows, kPerspectiveShadows, kCubeShadows}},
      {kSoft, {kPerspectiveShadows, kCubeShadows, kParallelShadows}},
      {kExact, {kDirectionalLights, kPointLights, kSpotLights}},
      {kSoftExact, {kExact}},
      {kHoles, {kExact}},
      {kLift, {kPerspectiveShadows, kParallelShadows, kCubeShadows, kExact}},
      {kNormalMaps, {kPointLights, kDirectionalLights, kSpotLights}},
      {kOutputShadow, {kCubeShadows, kParallelShadows, kPerspectiveShadows}},
      {kParallelShadows, {kDirectionalLights}},
      {kPerspectiveShadows, {kSpotLights}},
      {kCubeShadows, {kPointLights, kSpotLights}},
      {kFogPerChannel, {kFogExp, kFogExp2}},
      {kFogRadial, {kFogLinear, kFogExp, kFogExp2}},
      {kLightLists, {kPointLights, kSpotLights, kDirectionalLights}},
  };
  return rules;
}

FeatureSet completed(FeatureSet features) {
  for (const Needs& rule : needs()) {
    bool met = !features.has(rule.feature);
    for (const Feature other : rule.any_of) met |= features.has(other);
    if (!met) features.set(rule.any_of[0]);
  }
  bool chosen = false;
  for (const Feature method : kShadowMethods) {
    if (chosen) features.set(method, false);
    chosen |= features.has(method);
  }
  if (!features.has(Feature::kExact))
    for (const Feature feature : {Feature::kHoles, Feature::kSoftExact}) features.set(feature, false);
  return features;
}

/// Two features, i < j, and whether they are on.
struct Pair {
  std::size_t i;
  bool i_on;
  std::size_t j;
  bool j_on;
};

/// A set of pairs, a bit each. One is chosen whenever the program starts.
using Pairs = std::bitset<4 * kFeatureCount * kFeatureCount>;
std::size_t bitOf(const Pair& pair) {
  return (2 * pair.i + std::size_t(pair.i_on)) * 2 * kFeatureCount + 2 * pair.j + std::size_t(pair.j_on);
}

/// Every two features in every state of both that these features show.
Pairs pairsIn(const FeatureSet& features) {
  Pairs pairs;
  for (std::size_t i = 0; i < kFeatureCount; ++i)
    for (std::size_t j = i + 1; j < kFeatureCount; ++j)
      pairs.set(bitOf({i, features.has(static_cast<Feature>(i)), j, features.has(static_cast<Feature>(j))}));
  return pairs;
}

bool isShadowMethod(std::size_t feature) {
  return std::find(std::begin(kShadowMethods), std::end(kShadowMethods), static_cast<Feature>(feature)) !=
         std::end(kShadowMethods);
}

/// The pairs that no set shows: a feature without the one that it cannot do without, two shadow methods,
/// holes or lights of a size with another method than the one that knows them.
bool impossible(const Pair& pair) {
  const auto [i, i_on, j, j_on] = pair;
  if (i_on && j_on && isShadowMethod(i) && isShadowMethod(j)) return true;
  const auto isOfExact = [](std::size_t feature) {
    return Feature(feature) == Feature::kHoles || Feature(feature) == Feature::kSoftExact;
  };
  const auto isOther = [](std::size_t feature) {
    return isShadowMethod(feature) && Feature(feature) != Feature::kExact;
  };
  if (i_on && j_on && ((isOfExact(i) && isOther(j)) || (isOfExact(j) && isOther(i)))) return true;
  for (const Needs& rule : needs()) {
    if (rule.any_of.size() > 1) continue;
    const auto feature = std::size_t(rule.feature), other = std::size_t(rule.any_of[0]);
    if ((i == feature && i_on && j == other && !j_on) || (j == feature && j_on && i == other && !i_on))
      return true;
  }
  return false;
}

Pairs allPairs() {
  Pairs pairs;
  for (std::size_t i = 0; i < kFeatureCount; ++i)
    for (std::size_t j = i + 1; j < kFeatureCount; ++j)
      for (const bool i_on : {false, true})
        for (const bool j_on : {false, true})
          if (!impossible({i, i_on, j, j_on})) pairs.set(bitOf({i, i_on, j, j_on}));
  return pairs;
}

/// Few sets that together show every possible pair (a covering array of strength 2), by greedy choice from
/// random sets.
std::vector<FeatureSet> coveringSets() {
  Random random(42);
  Pairs missing = allPairs();
  std::vector<FeatureSet> sets;
  while (missing.any() && sets.size() < 100) {
    FeatureSet best;
    std::size_t most = 0;
    for (int attempt = 0; attempt < 400; ++attempt) {
      FeatureSet candidate;
      const double density = random.between(0.15, 0.85);
      for (std::size_t i = 0; i < kFeatureCount; ++i)
        candidate.set(static_cast<Feature>(i), random.chance(density));
      candidate = completed(candidate);
      const std::size_t covers = (pairsIn(candidate) & missing).count();
      if (covers > most) {
        most = covers;
        best = candidate;
      }
    }
    if (most == 0) continue;
    missing &= ~pairsIn(best);
    sets.push_back(best);
  }
  return sets;
}

template <class T>
T pick(const std::vector<T>& values, Random& random) {
  return values[random.below(int(values.size()))];
}

FogMode fogMode(const FeatureSet& features, Random& random) {
  std::vector<FogMode> modes;
  if (features.has(Feature::kFogLinear) && !features.has(Feature::kFogPerChannel))
    modes.push_back(FogMode::kLinear);
  if (features.has(Feature::kFogExp)) modes.push_back(FogMode::kExp);
  if (features.has(Feature::kFogExp2)) modes.push_back(FogMode::kExp2);
  return modes.empty() ? FogMode::kNone : pick(modes, random);
}

/// A random light that uses these features and no others.
Light lightWith(const FeatureSet& features, const std::vector<LightKind>& kinds, const Camera& camera,
                Random& random) {
  Light light = randomLight(camera, random);
  light.kind = pick(kinds, random);
  light.attenuation = features.has(Feature::kAttenuation) ? glm::vec3(0.5f, 0.1f, 0.02f) : glm::vec3(1, 0, 0);
  const bool smooth = features.has(Feature::kSmoothWindow), khr = features.has(Feature::kKhrWindow);
  light.range = smooth || khr ? float(random.between(5, 30)) : std::numeric_limits<float>::infinity();
  light.window = khr && (!smooth || random.chance(0.5)) ? RangeWindow::kKhr : RangeWindow::kSmooth;
  if (!features.has(Feature::kSpecular)) light.specular = glm::vec3(0);
  if (!features.has(Feature::kLightAmbient)) light.ambient = glm::vec3(0);
  const bool cone = features.has(Feature::kSpotCone), exponent = features.has(Feature::kSpotExponent);
  light.falloff = cone && (!exponent || random.chance(0.5)) ? SpotFalloff::kCone : SpotFalloff::kExponent;
  light.exponent = exponent ? 12.5f : 0.0f;
  // Both sides of what one perspective map can show.
  const bool one_map = features.has(Feature::kPerspectiveShadows) &&
                       (!features.has(Feature::kCubeShadows) || random.chance(0.5));
  light.cutoff = glm::radians(one_map ? 50.0 : 80.0);
  light.inner_cone = 0.5 * light.cutoff;
  if (features.has(Feature::kSoftExact)) {
    light.radius = 0.3;
    light.half_angle = 0.1;
  }
  light.shadow = features.has(Feature::kExact) ||
                 features.has(light.kind == LightKind::kDirectional ? Feature::kParallelShadows
                              : usesCubeMap(light)                  ? Feature::kCubeShadows
                                                                    : Feature::kPerspectiveShadows);
  return light;
}

/// A scene that uses these features and no others, with a few triangles to cast shadows.
Scene sceneWith(const FeatureSet& features, const Camera& camera, Random& random) {
  Scene scene = randomScene(camera, 0, random);
  std::vector<LightKind> kinds;
  if (features.has(Feature::kPointLights)) kinds.push_back(LightKind::kPoint);
  if (features.has(Feature::kDirectionalLights)) kinds.push_back(LightKind::kDirectional);
  if (features.has(Feature::kSpotLights)) kinds.push_back(LightKind::kSpot);
  for (int i = 0; i < 6 && !kinds.empty(); ++i)
    scene.lights.push_back(lightWith(features, kinds, camera, random));
  if (!features.has(Feature::kAmbient)) scene.ambient = glm::vec3(0);
  scene.fog = randomFog(fogMode(features, random), random);
  scene.fog.radial = features.has(Feature::kFogRadial);
  if (!features.has(Feature::kFogPerChannel)) scene.fog.density = glm::vec3(scene.fog.density.x);
  Mesh mesh;
  for (int i = 0; i < 60; ++i) {
    const glm::vec3 corner(random.between(-10, 10), random.between(-10, 10), random.between(-30, -2));
    for (int c = 0; c < 3; ++c) mesh.positions.push_back(corner + glm::vec3(random.direction()));
    mesh.normals.resize(mesh.positions.size(), glm::vec3(0, 0, 1));
    mesh.triangles.push_back(glm::uvec3(3 * i, 3 * i + 1, 3 * i + 2));
    mesh.triangle_materials.push_back(0);
  }
  scene.materials.resize(1);
  if (features.has(Feature::kHoles)) scene.materials[0].alpha_cutoff = 0.5f;
  scene.meshes.push_back(mesh);
  scene.objects.push_back({0, camera.camera_to_world, -1});
  return scene;
}

/// Lights the G-buffer by the program of exactly `needed`, and by the program of all features: the same
/// picture, bit for bit, because a feature that is not used adds 0, multiplies by 1, or is not chosen at run
/// time, and the operations that are left are the same in both. How shadow maps are filtered is a choice of
/// method, which no scene makes; both have it alike.
void expectSamePicture(const Scene& scene, const GBuffer& gbuffer, const FeatureSet& needed, Model model) {
  OpenedDevice& device = deviceWithLanes(listDevices().at(selectDevice(listDevices(), "")).lanes);
  const FeatureSet all = everyFeature(needed);
  const ShadowMethod method = needed.has(Feature::kSoftExact) ? ShadowMethod::kSoftExact
                              : needed.has(Feature::kExact)   ? ShadowMethod::kExact
                              : needed.has(Feature::kSoft)    ? ShadowMethod::kSoft
                              : needed.has(Feature::kPcf)     ? ShadowMethod::kPcf
                                                              : ShadowMethod::kHard;
  Lighting lighting;
  Stats stats;
  prepareLighting(device, scene, gbuffer.camera, cameraView(gbuffer.camera, gbuffer.picture_size), needed,
                  {.model = model, .shadows = method}, lighting, stats);
  const Plane least = lightGBuffer(device, scene, lighting, {lighting.lights, needed, gbuffer}, stats).color;
  Plane most = lightGBuffer(device, scene, lighting, {lighting.lights, all, gbuffer}, stats).color;
  ASSERT_EQ(most.size(), 4 * gbuffer.pixels());
  most.resize(least.size());
  std::size_t different = 0;
  for (std::size_t i = 0; i < least.size(); ++i) {
    if (least[i] == most[i]) continue;
    if (++different < 5)
      ADD_FAILURE() << "value " << i << ": " << least[i] << " by the least program, " << most[i]
                    << " by the full";
  }
  EXPECT_EQ(different, 0u) << "of " << least.size() << " values; " << featureDefines(needed);
  if (!isGeneral(needed)) return;
  // As a first picture is lit: by the general program, and with the planes that a picture of its own has.
  const PlaneSet planes = neededPlanes(needed);
  GBuffer fewer = gbuffer;
  if (!planes.specular) fewer.specular = {};
  if (!planes.ambient) fewer.ambient = {};
  if (!planes.emission) fewer.emission = {};
  device.lights_generally = true;
  const Plane general = lightGBuffer(device, scene, lighting, {lighting.lights, needed, fewer}, stats).color;
  device.lights_generally = false;
  EXPECT_TRUE(general == least) << featureDefines(needed);
}

void expectSamePicture(const FeatureSet& features) {
  Random random(8);
  Camera camera = randomCamera(random);
  camera.orthographic = features.has(Feature::kParallelView);
  camera.half_height = 10;
  const Scene scene = sceneWith(features, camera, random);
  GBuffer gbuffer = randomGBuffer(camera, 39, 20, 0.1, random);
  if (!features.has(Feature::kEmission)) std::fill(gbuffer.emission.begin(), gbuffer.emission.end(), 0.0f);
  if (features.has(Feature::kLift)) {
    gbuffer.lift.resize(gbuffer.pixels());
    for (float& lift : gbuffer.lift) lift = random.chance(0.5) ? 0.0f : float(random.between(0, 0.5));
  }
  std::vector<Model> models;
  for (const Model model : kAllModels)
    if (features.has(featureOf(model))) models.push_back(model);
  if (features.has(Feature::kMaterialModels)) {
    gbuffer.model.resize(gbuffer.pixels());
    for (std::uint32_t& number : gbuffer.model)
      number = random.chance(0.2) ? 0 : modelNumber(pick(models, random));
  }
  expectSamePicture(scene, gbuffer, features, models.empty() ? Model::kPhong : pick(models, random));
}

std::string featureTestName(const testing::TestParamInfo<std::size_t>& info) {
  std::string name = kFeatureTable[info.param].define;
  std::erase(name, '_');
  return name;
}

class FeatureAlone : public testing::TestWithParam<std::size_t> {};

TEST_P(FeatureAlone, LooksAsWithAllOthers) {
  FeatureSet features;
  features.set(static_cast<Feature>(GetParam()));
  expectSamePicture(completed(features));
}
INSTANTIATE_TEST_SUITE_P(Each, FeatureAlone, testing::Range<std::size_t>(0, kFeatureCount), featureTestName);

class FeaturePairs : public testing::TestWithParam<FeatureSet> {};

TEST_P(FeaturePairs, LookAsWithAllOthers) { expectSamePicture(GetParam()); }
INSTANTIATE_TEST_SUITE_P(Covering, FeaturePairs, testing::ValuesIn(coveringSets()),
                         [](const auto& set) { return std::to_string(set.index); });

TEST(Features, CoveringSetsShowEveryPossiblePair) {
  Pairs missing = allPairs();
  for (const FeatureSet& features : coveringSets()) missing &= ~pairsIn(features);
  for (std::size_t i = 0; i < kFeatureCount; ++i)
    for (std::size_t j = i + 1; j < kFeatureCount; ++j)
      for (const bool i_on : {false, true})
        for (const bool j_on : {false, true})
          EXPECT_FALSE(missing[bitOf({i, i_on, j, j_on})])
              << kFeatureTable[i].define << "=" << i_on << " " << kFeatureTable[j].define << "=" << j_on
              << " is never shown";
}

TEST(Features, OfManyPicturesTheGeneralProgramHasAll) {
  EXPECT_TRUE(isGeneral(generalFeatures()));
  EXPECT_FALSE(isGeneral({}));
  // No set of pairs leaves out shadow maps, filters, holes and normal maps together; those that do are here.
  Random random(3);
  for (int i = 0; i < 12; ++i) {
    FeatureSet features;
    for (std::size_t j = 0; j < kFeatureCount; ++j)
      features.set(Feature(j), generalFeatures().has(Feature(j)) && random.chance(0.5));
    features.set(Feature::kLightLists);
    features.set(Feature::kExact);
    features = completed(features);
    ASSERT_TRUE(isGeneral(features)) << featureDefines(features);
    expectSamePicture(features);
  }
}

TEST(Features, NoneAtAllLooksAsWithAll) { expectSamePicture(FeatureSet{}); }

TEST(Features, UnlitSceneLooksAsWithAll) {
  Random random(8);
  const Camera camera = randomCamera(random);
  Scene scene = randomScene(camera, 5, random);
  scene.lighting = false;
  const GBuffer gbuffer = randomGBuffer(camera, 39, 20, 0.1, random);
  expectSamePicture(scene, gbuffer, neededFeatures(scene, camera, {.specular = true, .emission = true}, {}),
                    Model::kPhong);
}

TEST(Features, RealScenesLookAsWithAll) {
  LUCIOLE_NEEDS_SHARED();
  // Each scene by the usual settings, and by others of which each has a scene.
  const std::pair<const char*, ShadeSettings> cases[] = {
      {"cornell_box/CornellBox-Original.obj", {.model = Model::kBlinnPhong, .culling = Culling::kNone}},
      {"khronos_LightsPunctualLamp/glTF/LightsPunctualLamp.gltf", {.model = Model::kToon}},
      {"khronos_Duck/glTF/Duck.gltf", {.model = Model::kCookTorrance}},
      {"utah_teapot/teapot.obj", {.model = Model::kOrenNayar}}};
  for (const auto& [file, others] : cases) {
    SCOPED_TRACE(file);
    const Scene scene = loadScene((sharedScenes() / file).string());
    const View view = cameraView(scene.cameras[0], {97, 64});
    std::vector<std::uint32_t> objects(scene.objects.size());
    for (std::uint32_t i = 0; i < objects.size(); ++i) objects[i] = i;
    GBuffer gbuffer = rasterize(scene, objects, view, Shading::kPhong, {true, true, true});
    gbuffer.camera = scene.cameras[0];
    for (const ShadeSettings& settings : {ShadeSettings{}, others})
      expectSamePicture(scene, gbuffer,
                        neededFeatures(scene, gbuffer.camera, materialTraits(scene), settings),
                        settings.model);
  }
}

}  // namespace
}  // namespace luciole::test
