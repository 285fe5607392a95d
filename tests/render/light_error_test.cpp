// --light-error: a picture in which clusters stand for lights is as close to the exact one as its layer says.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>

#include "raster/bins.hpp"
#include "render_json.hpp"
#include "shade/clustered_light.hpp"

namespace luciole::test {
namespace {

/// Lights that others may stand for, with others that are summed by themselves and cast shadows. `changes`:
/// further keys of the scene.
std::string manyLights(
    const std::string& emission, const std::string& changes = "",
    const std::string& exact =
        R"(, {"type": "directional", "direction": [-1, -2, -1], "intensity": 0.5, "shadow": true},
     {"type": "spot", "position": [-2, 4, 2], "target": [0, 0, 0], "cutoff": 40, "intensity": 0.5},
     {"type": "point", "position": [1, 2, 2], "range": 4, "shadow": true})") {
  std::string lights;
  for (int i = 0; i < 2100; ++i) {
    const int plane = i / 210;
    lights += fmt::format(
        R"({}{{"type": "point", "position": [{}, {}, {}], "color": [1, 0.5, 0.2], "intensity": 0.002, "attenuation": [0, 0, 1]}})",
        i ? "," : "", 0.2 * (i % 21) - 2.1, 1.5 + 0.1 * (i / 21 % 10), 0.4 * plane - 2.1);
  }
  return R"({"camera": {"eye": [3, 2, 5], "target": [0, 0.5, 0], "fov_y": 60}, "background": [0, 0, 0.25], "ambient": 0.05,
  "materials": {"m": {"diffuse": [0.6, 0.5, 0.4], "specular": 0, "shininess": 32)" +
         emission + R"(}},
  "objects": [{"primitive": "plane", "scale": 8, "segments": 9, "material": "m"}, {"primitive": "sphere", "translate": [0, 1, 0], "material": "m"}],
  )" + changes +
         R"("lights": [)" + lights + exact + "]}";
}

constexpr const char* kEmits = R"(, "emission": [0.2, 0.1, 0])";
constexpr const char* kThickFog =
    R"("fog": {"mode": "exp2", "density": [0.05, 0.02, 0.01], "color": [0.2, 0.3, 0.4]},)";

/// Both pictures, the second by clusters with its bounds.
struct Both {
  Image exact, clustered;
  Stats stats;
};

Both renderBoth(const Scene& scene, RenderSettings settings, bool always_clusters = true) {
  Both both;
  both.exact = picture(scene, settings);
  settings.shade.light_error = 1.0f / 256;
  settings.shade.always_clusters = always_clusters;
  settings.aovs.push_back(Aov::kLightError);
  settings.count_lights = true;
  both.clustered = renderScene(testDevice(), scene, settings, both.stats);
  return both;
}

/// The exact picture errs, too. Each of the 2100 lights of 0.002 gives at most 0.002 / d², of which d² > 1 in
/// the mean, so all of them 4.2. A cosine errs by 8 · 2⁻²⁴, a highlight by n = 32 times as much: 4.2 · (0.6 ·
/// 8
/// + 0.5 · 256) · 2⁻²⁴ < 2⁻¹⁴. The few other lights, and the roundings of sums, add less than what is left.
constexpr double kExactError = 0x1p-14;

void expectWithinBounds(const Both& both) {
  const Image &exact = both.exact, &clustered = both.clustered;
  const std::size_t layer = channelIndex(clustered, "light_error.R"), channels = clustered.channels.size();
  ASSERT_EQ(clustered.channels[layer + 1], "light_error.G");
  ASSERT_EQ(clustered.channels[layer + 2], "light_error.B");
  ASSERT_EQ(exact.pixels.size() / exact.channels.size(), clustered.pixels.size() / channels);
  std::size_t bounded = 0;
  for (std::size_t pixel = 0; pixel < clustered.pixels.size() / channels; ++pixel) {
    for (int c = 0; c < 3; ++c) {
      const double color = clustered.pixels[pixel * channels + c],
                   bound = clustered.pixels[pixel * channels + layer + c];
      const double truth = exact.pixels[pixel * exact.channels.size() + c];
      bounded += bound > 0;
      ASSERT_GE(bound, 0);
      ASSERT_LE(bound, std::max(color, 1.0) / 256);
      ASSERT_LE(std::abs(color - truth), bound + kExactError) << "pixel " << pixel << " channel " << c;
    }
  }
  EXPECT_GT(bounded, clustered.pixels.size() / channels / 4);
  EXPECT_EQ(countOf(both.stats, "lights_stood_for"), 2100u);
  EXPECT_GT(both.stats.light_error.largest, 0);
  EXPECT_GE(both.stats.light_error.largest * double(both.stats.light_error.values),
            both.stats.light_error.sum);
}

TEST(LightError, PicturesAreWithinTheirBoundsInAllShadingsFogAndEmission) {
  for (const char* emission : {"", kEmits})
    for (const char* fog : {"", kThickFog}) {
      const Scene scene = sceneFromJson(manyLights(emission, fog));
      for (const Shading shading : {Shading::kPhong, Shading::kFlat, Shading::kGouraud}) {
        SCOPED_TRACE(fmt::format("{} {} {}", emission, fog, int(shading)));
        RenderSettings settings = settingsFor(scene, {40, 30});
        settings.shading = shading;
        expectWithinBounds(renderBoth(scene, settings));
      }
    }
}

TEST(LightError, PicturesWithShadowsOfLightsOfASizeAreWithinTheirBounds) {
  const Scene scene = sceneFromJson(manyLights(kEmits, kThickFog, R"(,
     {"type": "directional", "direction": [-1, -2, -1], "intensity": 0.5, "angle": 5, "shadow": true},
     {"type": "point", "position": [1, 2, 2], "range": 4, "radius": 0.3, "shadow": true})"));
  for (const ShadowMethod method : {ShadowMethod::kSoftExact, ShadowMethod::kAuto}) {
    RenderSettings settings = settingsFor(scene, {40, 30});
    settings.shade.shadows = method;
    // A directional light that is sampled has exact shadows, so the picture that it is held against has.
    if (method == ShadowMethod::kAuto)
      settings.shade.shadow_ways.assign(scene.lights.size(), ShadowWay::kBeams);
    expectWithinBounds(renderBoth(scene, settings));
  }
}

// Of nearly dark pixels any cluster is accepted. The groups after them start from what those accepted.
TEST(LightError, PixelsAfterNearlyDarkOnesAreNotLitLightByLight) {
  std::string lights;
  for (int i = 0; i < 20'000; ++i) {
    const int row = i / 1000;
    lights += fmt::format(
        R"({}{{"type": "point", "position": [{}, {}, {}], "intensity": 0.0002, "attenuation": [0, 0, 1]}})",
        i ? "," : "", 0.1 * (i % 100) - 5, 1 + 0.1 * (i / 100 % 10), 0.2 * row - 2);
  }
  const auto lightsOf = [&](const char* dark) {
    // Right of six tiles that are dark two are bright, in each run of tiles that is lit one after another.
    std::string objects;
    for (int i = 0; i < 2; ++i)
      objects += fmt::format(
          R"({}{{"primitive": "plane", "translate": [{}, 0, 0], "scale": [1.5, 1, 3], "material": "dark"}},
             {{"primitive": "plane", "translate": [{}, 0, 0], "scale": [0.5, 1, 3], "material": "bright"}})",
          i ? "," : "", 4 * i - 2.5, 4 * i - 0.5);
    const Scene scene = sceneFromJson(fmt::format(
        R"({{"camera": {{"eye": [0, 9, 0], "target": [0, 0, 0], "up": [0, 0, -1], "orthographic": 2}},
        "materials": {{"dark": {{"diffuse": {0}, "specular": {0}}}, "bright": {{"diffuse": 0.7, "specular": 0.3, "shininess": 20}}}},
        "objects": [{1}], "lights": [{2}]}})",
        dark, objects, lights));
    RenderSettings settings = settingsFor(scene, {256, 128});
    settings.shade.light_error = 1.0f / 64;
    settings.shade.always_clusters = true;
    settings.count_lights = true;
    Stats stats;
    renderScene(testDevice(), scene, settings, stats);
    return double(countOf(stats, "pixel_clustered_lights_evaluated"));
  };
  // Black pixels ask for nothing at all.
  EXPECT_LT(lightsOf("1e-9"), 1.5 * lightsOf("0"));
}

TEST(LightError, SamplesAreWithinTheMeanOfTheirBounds) {
  const Scene scene = sceneFromJson(manyLights(kEmits, kThickFog));
  for (const auto shading : {SampleShading::kShared, SampleShading::kAll})
    for (const Model model : {Model::kPhong, Model::kBlinnPhong}) {
      RenderSettings settings = settingsFor(scene, {40, 30});
      settings.samples = 4;
      settings.sample_shading = shading;
      settings.shade.model = model;
      settings.exposure = -0.5f;
      expectWithinBounds(renderBoth(scene, settings));
    }
}

TEST(LightError, WithoutOtherLightsNoneIsLeftToTheShadingKernels) {
  const Scene scene = sceneFromJson(manyLights("", "", ""));
  const Both both = renderBoth(scene, settingsFor(scene, {40, 30}));
  expectWithinBounds(both);
  EXPECT_EQ(countOf(both.stats, "pixel_lights_evaluated"), 0u);
  EXPECT_EQ(countOf(both.stats, "lights_exact"), 0u);
}

TEST(LightError, BandsAreThePictureBitForBit) {
  const Scene scene = sceneFromJson(manyLights(kEmits, kThickFog));
  const struct {
    int samples;
    SampleShading shading;
  } cases[] = {{1, SampleShading::kAll},
               {4, SampleShading::kAll},
               {4, SampleShading::kShared},
               {33, SampleShading::kShared}};
  for (const auto& [samples, shading] : cases)
    for (const std::optional<Crop>& crop : {std::optional<Crop>(), std::optional(Crop{7, 70, 140, 200})}) {
      SCOPED_TRACE(fmt::format("{} samples, {}, {}", samples, int(shading), crop ? "crop" : "whole"));
      RenderSettings settings = settingsFor(scene, {160, 290});
      settings.crop = crop;
      settings.samples = samples;
      settings.sample_shading = shading;
      settings.shade.light_error = 1.0f / 256;
      settings.shade.always_clusters = true;
      settings.aovs = {Aov::kLightError, Aov::kShadingCount};
      settings.band_height = 1 << 20;
      const Image whole = picture(scene, settings);
      for (const int height : {kBinSize, 2 * kBinSize, 3 * kBinSize}) {
        settings.band_height = height;
        EXPECT_EQ(picture(scene, settings).pixels, whole.pixels) << height;
      }
    }
}

// A crop has other groups of pixels, so other clusters.
TEST(LightError, CropsAreWithinTheirBounds) {
  const Scene scene = sceneFromJson(manyLights(kEmits, kThickFog));
  RenderSettings settings = settingsFor(scene, {40, 100});
  settings.crop = Crop{7, 30, 20, 50};
  expectWithinBounds(renderBoth(scene, settings));
}

TEST(LightError, AnErrorOfZeroOrFewLightsIsTheExactPictureWithBoundsOfZero) {
  Scene scene = sceneFromJson(manyLights(kEmits));
  RenderSettings settings = settingsFor(scene, {40, 30});
  const View view = cameraView(settings.camera, settings.size);
  EXPECT_FALSE(standIns(scene, view, materialTraits(scene), settings.shade).clustered);
  scene.lights.resize(100);
  ASSERT_FALSE(clustersAreFaster({100, 1.0f / 256, false}, view));
  const Both both = renderBoth(scene, settings, false);
  for (std::size_t i = 0; i < both.clustered.pixels.size(); ++i) {
    if (i % 6 < 3)
      ASSERT_EQ(both.clustered.pixels[i], both.exact.pixels[i / 6 * 3 + i % 6]);
    else
      ASSERT_EQ(both.clustered.pixels[i], 0);
  }
  EXPECT_EQ(countOf(both.stats, "lights_stood_for"), 0u);
  EXPECT_EQ(countOf(both.stats, "lights_exact_as_few"), 100u);
}

/// Whether clusters pay for so many lights on matte surfaces.
bool pays(std::size_t lights, const Camera& camera, glm::ivec2 size, const std::optional<Crop>& crop = {}) {
  return clustersAreFaster({lights, 1.0f / 256, false}, cameraView(camera, size, crop));
}

// A group of pixels shares a walk through the tree, and holds fewer pixels the wider each of them is.
TEST(LightError, ClustersPayFromMoreLightsOnWhereAPixelIsWider) {
  Camera camera;
  camera.fov_y = glm::radians(60.0);
  EXPECT_FALSE(pays(100, camera, {1280, 720}));
  EXPECT_TRUE(pays(2000, camera, {1280, 720}));
  EXPECT_FALSE(pays(2000, camera, {320, 180}));
  EXPECT_TRUE(pays(2000, camera, {320, 180}, Crop{0, 0, 8, 8}) == pays(2000, camera, {320, 180}))
      << "a crop has groups as large as its picture";
  EXPECT_TRUE(pays(20'000, camera, {320, 180}));
  camera.fov_y = glm::radians(15.0);
  EXPECT_TRUE(pays(2000, camera, {320, 180}));
  // Of a parallel view as of one that is as high as it is far away.
  Camera parallel;
  parallel.orthographic = true;
  camera.fov_y = 2 * std::atan(0.5);
  for (const double half_height : {0.1, 100.0}) {
    parallel.half_height = half_height;
    for (const glm::ivec2& size : {glm::ivec2(1280, 720), glm::ivec2(320, 180)})
      for (std::size_t lights = 100; lights < 100'000; lights += lights / 10)
        EXPECT_EQ(pays(lights, parallel, size), pays(lights, camera, size)) << lights;
  }
}

// Each light is put into the tree, which takes as long as to sum it at some thousands of pixels.
TEST(LightError, ClustersNeverPayForAHandfulOfPixels) {
  Camera camera;
  camera.fov_y = glm::radians(1.0);
  EXPECT_FALSE(pays(10'000'000, camera, {64, 36}));
  EXPECT_TRUE(pays(10'000'000, camera, {640, 360}));
}

TEST(LightError, StatsSayWhyLightsAreExact) {
  const Scene scene = sceneFromJson(manyLights(""));
  RenderSettings settings = settingsFor(scene, {8, 8});
  const Both shadowed = renderBoth(scene, settings);
  EXPECT_EQ(countOf(shadowed.stats, "lights_exact"), 3u);
  EXPECT_EQ(countOf(shadowed.stats, "lights_exact_by_kind"), 1u);  // the spot
  EXPECT_EQ(countOf(shadowed.stats, "lights_exact_by_shadow"), 2u);
  settings.shade.shadows = ShadowMethod::kOff;
  EXPECT_EQ(countOf(renderBoth(scene, settings).stats, "lights_exact_by_range"), 1u);
}

TEST(LightError, ExactShadowsOfOtherLightsStayThoseOfTheirLights) {
  const Scene scene = sceneFromJson(manyLights(kEmits));
  RenderSettings settings = settingsFor(scene, {40, 30});
  settings.shade.shadows = ShadowMethod::kExact;
  expectWithinBounds(renderBoth(scene, settings));
}

TEST(LightError, GBuffersAreLitAsTheSceneIs) {
  const Scene scene = sceneFromJson(manyLights(kEmits, kThickFog));
  RenderSettings settings = settingsFor(scene, {40, 30});
  Stats stats;
  const GBuffer gbuffer = rasterizeScene(nullptr, scene, settings, stats);
  settings.shade.light_error = 1.0f / 256;
  settings.shade.always_clusters = true;
  settings.aovs = {Aov::kLightError};
  EXPECT_EQ(shadeGBuffer(testDevice(), scene, gbuffer, settings, stats).pixels,
            picture(scene, settings).pixels);
}

}  // namespace
}  // namespace luciole::test
