// Layers that hold a part of a picture's light each add up to the picture.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "image/light_names.hpp"
#include "lighting/light_layers.hpp"
#include "long_run.hpp"
#include "luciole/error.hpp"
#include "render_json.hpp"

namespace luciole::test {
namespace {

/// Lights of three groups and of none, of every kind, with ambient light of their own; fog, emission, and
/// background beside the surfaces.
constexpr const char* kGroupsScene =
    R"({"camera": {"eye": [3, 2, 5], "target": [0, 0.5, 0], "fov_y": 60}, "background": [0, 0, 0.25], "ambient": 0.1,
  "fog": {"mode": "exp2", "density": [0.05, 0.02, 0.01], "color": [0.2, 0.3, 0.4]},
  "materials": {"m": {"diffuse": [0.6, 0.5, 0.4], "specular": 0.5, "shininess": 32}, "e": {"emission": [0.2, 0.1, 0]}},
  "objects": [{"primitive": "plane", "scale": 4, "material": "m"}, {"primitive": "sphere", "translate": [0, 1, 0], "material": "m"},
              {"primitive": "torus", "translate": [1, 0.5, 2], "rotate": [60, 0, 20], "material": "e"}],
  "lights": [{"type": "directional", "direction": [-1, -2, -1], "intensity": 0.5, "shadow": true, "angle": 3},
             {"type": "point", "position": [1, 2, 2], "radius": 0.1, "range": 4, "shadow": true, "color": [1, 0.5, 0.2], "group": "key"},
             {"type": "point", "position": [-1, 2, 2], "range": 4, "ambient": 0.3, "diffuse": 0.4, "specular": 2, "group": "rim"},
             {"type": "spot", "position": [-2, 4, 2], "target": [0, 0, 0], "cutoff": 40, "exponent": 4, "shadow": true, "group": "key"}],
  "light_fields": [{"count": 200, "seed": 3, "min": [-4, 0, -4], "max": [4, 2, 4], "range": 0.8, "intensity": 0.5, "group": "field"}]})";

const std::vector<Aov> kParts{Aov::kAmbient, Aov::kDiffuseLight, Aov::kSpecularLight, Aov::kEmission,
                              Aov::kFog};

/// How far the sum of a picture's layers of light (taken in double) may be from a channel of the picture, as
/// a share of it. All terms are ≥ 0, so each rounding changes a sum by 2⁻²⁴ of it at most, and both sides of
/// the difference have at most: those of the sum over N lights, N − 1, but not more than kSumBlock + 4
/// (long_sum.clh); 8 by the material's products and sums; 3 by the fog's; 2 by each sample, its weight and
/// its sum; 1 by the exposure.
double boundOfSum(const Scene& scene, int samples) {
  const double lights = std::min(double(scene.lights.size()), double(kSumBlock + 4));
  return 2 * (lights + 8 + 3 + 2 * samples + 1) * 0x1p-24;
}

/// The channels of a picture whose names start like this and end with R, G or B.
std::vector<std::size_t> channelsOf(const Image& image, const std::vector<std::string>& layers,
                                    char component) {
  std::vector<std::size_t> found;
  for (std::size_t c = 0; c < image.channels.size(); ++c)
    for (const std::string& layer : layers)
      if (image.channels[c].starts_with(layer) && image.channels[c].back() == component) found.push_back(c);
  return found;
}

/// Compares the sum of these layers with the picture, and returns the largest difference in ulps of the
/// picture.
double expectSum(const Image& image, const std::vector<std::string>& layers, std::size_t count,
                 double bound) {
  double worst = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    const std::vector<std::size_t> channels = channelsOf(image, layers, "RGB"[c]);
    EXPECT_EQ(channels.size(), count);
    for (std::size_t i = 0; i < image.pixels.size(); i += image.channels.size()) {
      double sum = 0;
      for (const std::size_t channel : channels) sum += double(image.pixels[i + channel]);
      const float picture = image.pixels[i + c];
      // What is below 2⁻¹²⁶ may be 0.
      EXPECT_LE(std::abs(sum - picture), bound * picture + double(count) * 0x1p-120)
          << i << " " << image.channels[c];
      const double ulp = std::max(double(std::nextafter(picture, 2 * picture)) - picture, 0x1p-149);
      worst = std::max(worst, std::abs(sum - picture) / ulp);
    }
  }
  return worst;
}

const std::vector<std::string> kGroupLayers{std::string(kLightGroups)};
const std::vector<std::string> kPartLayers{std::begin(kLightParts), std::end(kLightParts)};

TEST(LightLayers, OfGroupsAndOfPartsAddUpToThePictureBySamplesAndShadowsOfAllKinds) {
  const Scene scene = sceneFromJson(kGroupsScene);
  double groups = 0, parts = 0;
  for (const auto method : {ShadowMethod::kOff, ShadowMethod::kHard, ShadowMethod::kSoft,
                            ShadowMethod::kExact, ShadowMethod::kSoftExact, ShadowMethod::kAuto}) {
    for (const auto& [samples, shading] :
         {std::pair{1, SampleShading::kShared}, std::pair{4, SampleShading::kShared},
          std::pair{3, SampleShading::kAll}}) {
      RenderSettings settings = settingsFor(scene, longRun() ? glm::ivec2(100, 80) : glm::ivec2(60, 48));
      settings.shade.shadows = method;
      settings.samples = samples;
      settings.sample_shading = shading;
      settings.exposure = 0.5f;
      settings.light_groups = true;
      settings.aovs = kParts;
      Stats stats;
      const Image image = renderScene(testDevice(), scene, settings, stats);
      groups = std::max(groups, expectSum(image, kGroupLayers, 5, boundOfSum(scene, samples)));
      parts = std::max(parts, expectSum(image, kPartLayers, 5, boundOfSum(scene, samples)));
      settings.light_groups = false;
      settings.aovs = {};
      const Image alone = renderScene(testDevice(), scene, settings, stats);
      for (std::size_t i = 0; i < alone.pixels.size(); ++i)
        ASSERT_EQ(alone.pixels[i], image.pixels[i / 3 * image.channels.size() + i % 3])
            << "layers change the picture";
    }
  }
  RecordProperty("groups_ulps", std::to_string(groups));
  RecordProperty("parts_ulps", std::to_string(parts));
  std::printf("largest difference: groups %.2f ulp, parts %.2f ulp\n", groups, parts);
}

TEST(LightLayers, OfShippedScenesAddUpToThePicture) {
  for (const char* name : {"city", "underwater", "cornell"}) {
    Scene scene = loadScene(std::string(LUCIOLE_SOURCE_DIR "/scenes/") + name + ".json");
    scene.light_groups = {"default", "a", "b"};
    for (std::size_t i = 0; i < scene.lights.size(); ++i) scene.lights[i].group = std::uint32_t(i % 3);
    RenderSettings settings = settingsFor(scene, {160, 90});
    settings.shade.shadows = ShadowMethod::kAuto;
    settings.light_groups = true;
    settings.aovs = kParts;
    Stats stats;
    const Image image = renderScene(testDevice(), scene, settings, stats);
    const double groups = expectSum(image, kGroupLayers, 4, boundOfSum(scene, 1));
    const double parts = expectSum(image, kPartLayers, 5, boundOfSum(scene, 1));
    std::printf("%s: groups %.2f ulp, parts %.2f ulp\n", name, groups, parts);
  }
}

TEST(LightLayers, AreTheSameInBandsAndOfAGBuffer) {
  const Scene scene = sceneFromJson(kGroupsScene);
  RenderSettings settings = settingsFor(scene, {100, 150});
  settings.shade.shadows = ShadowMethod::kExact;
  settings.light_groups = true;
  settings.aovs = kParts;
  Stats stats;
  for (const int samples : {1, 3}) {
    settings.samples = samples;
    settings.band_height = 1 << 20;
    const Image whole = renderScene(testDevice(), scene, settings, stats);
    settings.band_height = 64;
    const Image bands = renderScene(testDevice(), scene, settings, stats);
    EXPECT_EQ(bands.channels, whole.channels);
    EXPECT_EQ(bands.pixels, whole.pixels);
    if (samples > 1) continue;
    const GBuffer gbuffer = rasterizeScene(nullptr, scene, settings, stats);
    EXPECT_EQ(shadeGBuffer(testDevice(), scene, gbuffer, settings, stats).pixels, whole.pixels);
  }
}

TEST(LightLayers, HoldOnlyTheirOwnLight) {
  const Scene scene = sceneFromJson(kGroupsScene);
  RenderSettings settings = settingsFor(scene, {100, 80});
  settings.light_groups = true;
  Stats stats;
  const Image image = renderScene(testDevice(), scene, settings, stats);
  // With the lights of one group alone and nothing else the picture is that group's layer, to the bit.
  Scene alone = scene;
  std::erase_if(alone.lights, [&](const Light& light) { return scene.light_groups[light.group] != "rim"; });
  alone.ambient = alone.background = alone.fog.color = glm::vec3(0.0f);
  for (Material& material : alone.materials) material.emission = glm::vec3(0.0f);
  settings.light_groups = false;
  const Image picture = renderScene(testDevice(), alone, settings, stats);
  for (std::size_t c = 0; c < 3; ++c) {
    const std::size_t layer = channelsOf(image, {"light_groups.rim."}, "RGB"[c]).at(0);
    for (std::size_t i = 0; i < picture.pixels.size() / 3; ++i)
      ASSERT_EQ(picture.pixels[3 * i + c], image.pixels[i * image.channels.size() + layer]);
  }
}

TEST(LightLayers, WithAlphaLeaveTheBackgroundOut) {
  const Scene scene = sceneFromJson(kGroupsScene);
  RenderSettings settings = settingsFor(scene, {100, 80});
  settings.light_groups = settings.alpha = true;
  for (const int samples : {1, 4}) {
    settings.samples = samples;
    Stats stats;
    const Image image = renderScene(testDevice(), scene, settings, stats);
    expectSum(image, kGroupLayers, 5, boundOfSum(scene, samples));
  }
}

/// A scene whose lights are sampled, stood for by clusters and summed by themselves, as are those of some of
/// its groups alone; with what no light gives.
constexpr const char* kBoundedScene =
    R"({"camera": {"eye": [3, 2, 5], "target": [0, 0.5, 0], "fov_y": 60}, "background": [0, 0, 0.25], "ambient": 0.1,
  "fog": {"mode": "exp2", "density": [0.05, 0.02, 0.01], "color": [0.2, 0.3, 0.4]},
  "materials": {"m": {"diffuse": [0.6, 0.5, 0.4], "specular": 0.5, "shininess": 32},
                "e": {"diffuse": 0.5, "emission": [0.2, 0.1, 0]}},
  "objects": [{"primitive": "plane", "scale": 4, "material": "m"}, {"primitive": "sphere", "translate": [0, 1, 0], "material": "m"},
              {"primitive": "torus", "translate": [1, 0.5, 2], "rotate": [60, 0, 20], "material": "e"}],
  "lights": [{"type": "directional", "direction": [-1, -2, -1], "intensity": 0.3, "shadow": true},
             {"type": "point", "position": [1, 2, 2], "attenuation": [0, 0, 1], "shadow": true, "color": [1, 0.5, 0.2], "group": "few"},
             {"type": "point", "position": [-1, 3, 2], "attenuation": [0, 0, 1], "shadow": true, "diffuse": 0.4, "specular": 2, "group": "few"},
             {"type": "point", "position": [-2, 2, 2], "attenuation": [0, 0, 1], "diffuse": [0.4, 0.2, 1], "specular": 0.1, "group": "few"}],
  "light_fields": [{"count": 300, "seed": 3, "min": [-4, 0.2, -4], "max": [4, 3, 4], "no_range": true, "shadow": true, "intensity": 0.5, "group": "cast"},
                   {"count": 200, "seed": 4, "min": [-4, 0.2, -4], "max": [4, 3, 4], "no_range": true, "intensity": 0.3, "group": "open"}]})";

RenderSettings boundedSettings(const Scene& scene) {
  RenderSettings settings = settingsFor(scene, {100, 80});
  settings.shade.shadows = ShadowMethod::kExact;
  settings.shade.light_error = 1.0f / 32;
  settings.shade.always_clusters = true;
  settings.light_groups = true;
  settings.aovs = kParts;
  settings.aovs.push_back(Aov::kLightError);
  return settings;
}

std::size_t channelIndex(const Image& image, const std::string& name) {
  const auto found = std::find(image.channels.begin(), image.channels.end(), name);
  EXPECT_NE(found, image.channels.end()) << name;
  return std::size_t(found - image.channels.begin());
}

/// The share of the pixels' channels in which a layer is farther from the exact one than its bounds say. The
/// exact one's own rounding is boundOfSum().
double shareBeyondBounds(const Image& image, const Image& exact, const std::string& layer, double rounding) {
  std::size_t beyond = 0, count = 0;
  for (const char* component : {"R", "G", "B"}) {
    const std::size_t place = channelIndex(image, layer + component),
                      bounds = channelIndex(image, layer + std::string(kLayerBounds) + component),
                      truth = channelIndex(exact, layer + component);
    for (std::size_t i = 0; i < image.pixels.size() / image.channels.size(); ++i) {
      const float* const pixel = image.pixels.data() + i * image.channels.size();
      const double value = exact.pixels[i * exact.channels.size() + truth];
      beyond += std::abs(pixel[place] - value) > pixel[bounds] + rounding * value;
      ++count;
    }
  }
  return double(beyond) / double(count);
}

TEST(LightLayers, OfLightsWithAnErrorAreWithinBoundsOfTheirOwnAndAddUpWithinTheirSum) {
  const Scene scene = sceneFromJson(kBoundedScene);
  for (const auto& [samples, shading] :
       {std::pair{1, SampleShading::kShared}, std::pair{4, SampleShading::kShared},
        std::pair{3, SampleShading::kAll}}) {
    RenderSettings settings = boundedSettings(scene);
    settings.samples = samples;
    settings.sample_shading = shading;
    settings.exposure = 0.5f;
    const Image image = picture(scene, settings);
    RenderSettings without = settings;
    without.shade.light_error = 0;
    const Image exact = picture(scene, without);
    // Without an error there are no bounds of layers.
    EXPECT_EQ(image.channels.size(), exact.channels.size() + 3 * (5 + 5));
    const double rounding = boundOfSum(scene, samples);
    // Which pixels are shaded at all of their samples depends on the picture, so on its errors.
    const double most_other_points = samples == 4 ? 0.002 : 0;
    for (const char* sampled :
         {"light_groups.few.", "light_groups.cast.", "diffuse_light.", "specular_light."}) {
      const double share = shareBeyondBounds(image, exact, sampled, rounding);
      std::printf("%d samples, %s: %.4f beyond their bounds\n", samples, sampled, share);
      EXPECT_LT(share, 0.02) << sampled;
    }
    for (const char* proven : {"light_groups.default.", "light_groups.open.", "light_groups.rest.",
                               "ambient_light.", "emission_light.", "fog_light."})
      EXPECT_LE(shareBeyondBounds(image, exact, proven, rounding), most_other_points) << proven;
    for (const std::vector<std::string>& layers :
         {std::vector<std::string>{"light_groups.default.", "light_groups.few.", "light_groups.cast.",
                                   "light_groups.open.", "light_groups.rest."},
          kPartLayers}) {
      std::size_t beyond = 0;
      for (const char* component : {"R", "G", "B"})
        for (std::size_t i = 0; i < image.pixels.size(); i += image.channels.size()) {
          const auto at = [&](const std::string& name) {
            return double(image.pixels[i + channelIndex(image, name + component)]);
          };
          double sum = 0, bounds = at("light_error.");
          for (const std::string& layer : layers) {
            sum += at(layer);
            bounds += at(layer + std::string(kLayerBounds));
          }
          beyond += std::abs(sum - at("")) > bounds;
        }
      EXPECT_LT(double(beyond), 0.001 * 3 * 100 * 80) << layers.front();
    }
    settings.light_groups = false;
    settings.aovs = {Aov::kLightError};
    const Image alone = picture(scene, settings);
    for (std::size_t i = 0; i < alone.pixels.size(); ++i)
      ASSERT_EQ(alone.pixels[i], image.pixels[i / 6 * image.channels.size() + i % 6])
          << "layers change the picture";
  }
}

TEST(LightLayers, OfLightsWithAnErrorAreTheSameInBandsOfAGBufferAndInMemoryOfTheDevice) {
  const Scene scene = sceneFromJson(kBoundedScene);
  RenderSettings settings = boundedSettings(scene);
  settings.size = {100, 150};
  settings.band_height = 1 << 20;
  const Image whole = picture(scene, settings);
  settings.band_height = 64;
  EXPECT_EQ(picture(scene, settings).pixels, whole.pixels);
  OpenedDevice device;
  openDevice("", device);
  device.shares_host_memory = false;
  EXPECT_EQ(picture(scene, settings, device).pixels, whole.pixels);
  Stats stats;
  const GBuffer gbuffer = rasterizeScene(nullptr, scene, settings, stats);
  EXPECT_EQ(shadeGBuffer(testDevice(), scene, gbuffer, settings, stats).pixels, whole.pixels);
}

TEST(LightLayers, AreOneAGroupThatHasLightsAndTooManyAreRefused) {
  Scene scene = sceneFromJson(kGroupsScene);
  RenderSettings settings;
  EXPECT_TRUE(lightLayers(scene, settings).empty());
  settings.light_groups = true;
  std::erase_if(scene.lights, [](const Light& light) { return light.group == 0; });
  std::vector<std::string> names;
  for (const LightLayer& layer : lightLayers(scene, settings)) names.push_back(layer.name);
  EXPECT_EQ(names, (std::vector<std::string>{"light_groups.key.", "light_groups.rim.", "light_groups.field.",
                                             "light_groups.rest."}));
  scene.lights.resize(1'000'000);
  scene.light_groups.resize(1'000'000, "many");
  for (std::uint32_t i = 0; i < scene.lights.size(); ++i) scene.lights[i].group = i;
  try {
    lightLayers(scene, settings);
    ADD_FAILURE() << "accepted";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("1000000 groups of lights, expected 4096 at most"),
              std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace luciole::test
