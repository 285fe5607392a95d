#include "shade/features.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "render_json.hpp"
#include "scene/models.hpp"

namespace luciole::test {
namespace {

FeatureSet featuresOf(const std::string& json, const ShadeSettings& settings = {}) {
  const Scene scene = sceneFromJson(json);
  return neededFeatures(scene, scene.cameras.front(), materialTraits(scene), settings);
}

FeatureSet setOf(std::initializer_list<Feature> features) {
  FeatureSet set;
  for (const Feature feature : features) set.set(feature);
  return set;
}

std::string withLight(const std::string& light, const std::string& more = "") {
  return R"({"objects": [{"primitive": "box"}], "lights": [)" + light + "]" + more + "}";
}

TEST(Features, EmptySceneNeedsNone) { EXPECT_EQ(featuresOf(withLight("")), FeatureSet()); }

TEST(Features, PlainLightsNeedOnlyTheirKind) {
  EXPECT_EQ(featuresOf(withLight(R"({"type": "point", "position": [0, 1, 0]})")),
            setOf({Feature::kPointLights, Feature::kPhong, Feature::kLightLists}));
  EXPECT_EQ(featuresOf(withLight(R"({"type": "directional", "direction": [0, -1, 0]})")),
            setOf({Feature::kDirectionalLights, Feature::kPhong, Feature::kLightLists}));
  EXPECT_EQ(featuresOf(withLight(
                R"({"type": "spot", "position": [0, 1, 0], "direction": [0, -1, 0], "cutoff": 30})")),
            setOf({Feature::kSpotLights, Feature::kPhong, Feature::kLightLists}));
}

TEST(Features, SpotOfCutoff180IsAPointLight) {
  EXPECT_EQ(
      featuresOf(withLight(
          R"({"type": "spot", "position": [0, 1, 0], "direction": [0, -1, 0], "cutoff": 180, "exponent": 9})")),
      setOf({Feature::kPointLights, Feature::kPhong, Feature::kLightLists}));
}

TEST(Features, ConesBesideExponentsAreToldApartAtRunTime) {
  const std::string both = R"({"type": "spot", "position": [0, 1, 0], "direction": [0, -1, 0], "cutoff": 30},
    {"type": "spot", "position": [0, 1, 0], "direction": [0, -1, 0], "inner_cone": 10, "outer_cone": 20})";
  const FeatureSet features = featuresOf(withLight(both));
  EXPECT_TRUE(features.has(Feature::kSpotCone));
  EXPECT_TRUE(features.has(Feature::kSpotExponent));
}

TEST(Features, SpecularNeedsBothASurfaceAndALight) {
  const std::string shiny = R"(, "materials": {"m": {"specular": 0.5}})";
  const std::string light = R"({"type": "point", "position": [0, 1, 0]})";
  EXPECT_TRUE(featuresOf(withLight(light, shiny)).has(Feature::kSpecular));
  EXPECT_FALSE(featuresOf(withLight(light)).has(Feature::kSpecular));
  EXPECT_FALSE(
      featuresOf(withLight(R"({"type": "point", "position": [0, 1, 0], "specular": [0, 0, 0]})", shiny))
          .has(Feature::kSpecular));
}

TEST(Features, OfTheModelsOnlyTheChosenOneWhereSomethingIsLit) {
  for (const Model model : kAllModels) {
    const FeatureSet lit =
        featuresOf(withLight(R"({"type": "point", "position": [0, 1, 0]})"), {.model = model});
    EXPECT_EQ(lit, setOf({Feature::kPointLights, featureOf(model), Feature::kLightLists}));
    EXPECT_EQ(featuresOf(withLight(""), {.model = model}), FeatureSet());
  }
}

TEST(Features, SwitchedOffShadowsAndCullingCostNothing) {
  const std::string scene = withLight(R"({"type": "point", "position": [0, 1, 0], "shadow": true})");
  EXPECT_TRUE(featuresOf(scene).has(Feature::kCubeShadows));
  ShadeSettings off;
  off.shadows = ShadowMethod::kOff;
  off.culling = Culling::kNone;
  EXPECT_EQ(featuresOf(scene, off), setOf({Feature::kPointLights, Feature::kPhong}));
}

TEST(Features, ShadowsStartAboveFacetsOnlyWhereAMeshIsSmooth) {
  const auto lifts = [](const char* primitive, const char* shadow, const ShadeSettings& settings) {
    return featuresOf(fmt::format(
                          R"({{"objects": [{{"primitive": "box"}}, {{"primitive": "{}"}}],
                              "lights": [{{"type": "point", "position": [0, 1, 0], "shadow": {}}}]}})",
                          primitive, shadow),
                      settings)
        .has(Feature::kLift);
  };
  EXPECT_TRUE(lifts("sphere", "true", {}));
  EXPECT_FALSE(lifts("plane", "true", {}));
  EXPECT_FALSE(lifts("sphere", "false", {}));
  EXPECT_FALSE(lifts("sphere", "true", {.shadows = ShadowMethod::kOff}));
}

TEST(Features, FogNeedsItsModeAndChannelsOnly) {
  const auto fog = [](const std::string& text) { return featuresOf(withLight("", R"(, "fog": )" + text)); };
  EXPECT_EQ(fog(R"({"mode": "exp", "density": 0.1})"), setOf({Feature::kFogExp}));
  EXPECT_EQ(fog(R"({"mode": "exp2", "density": [0.1, 0.2, 0.3]})"),
            setOf({Feature::kFogExp2, Feature::kFogPerChannel}));
  EXPECT_EQ(fog(R"({"mode": "linear", "start": 1, "end": 9, "distance": "radial"})"),
            setOf({Feature::kFogLinear, Feature::kFogRadial}));
}

TEST(Features, TableNamesEveryFeatureOnce) {
  for (std::size_t i = 0; i < kFeatureCount; ++i)
    for (std::size_t j = 0; j < i; ++j) {
      EXPECT_STRNE(kFeatureTable[i].define, kFeatureTable[j].define);
      EXPECT_STRNE(kFeatureTable[i].name, kFeatureTable[j].name);
    }
}

TEST(Features, GBufferGroupsFollowTheFeatures) {
  const PlaneSet none = neededPlanes(FeatureSet());
  EXPECT_FALSE(none.specular || none.ambient || none.emission || none.geometric_normal ||
               none.unbent_normal || none.lift);
  EXPECT_TRUE(neededPlanes(setOf({Feature::kSpecular})).specular);
  EXPECT_TRUE(neededPlanes(setOf({Feature::kAmbient})).ambient);
  EXPECT_TRUE(neededPlanes(setOf({Feature::kEmission})).emission);
  for (const Feature shadows :
       {Feature::kParallelShadows, Feature::kPerspectiveShadows, Feature::kCubeShadows})
    EXPECT_TRUE(neededPlanes(setOf({shadows})).geometric_normal);
  EXPECT_TRUE(neededPlanes(setOf({Feature::kLift})).lift);
  EXPECT_FALSE(neededPlanes(setOf({Feature::kCubeShadows})).unbent_normal);
  const PlaneSet bent = neededPlanes(setOf({Feature::kCubeShadows, Feature::kNormalMaps}));
  EXPECT_TRUE(bent.unbent_normal && !bent.geometric_normal);
}

}  // namespace
}  // namespace luciole::test
