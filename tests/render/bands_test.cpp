// A picture is rendered in bands of rows. Nobody sees that, in the picture or in what is counted.
#include <gtest/gtest.h>

#include <algorithm>

#include "raster/bins.hpp"
#include "render/memory.hpp"
#include "render_json.hpp"

namespace luciole::test {
namespace {

/// Triangles of all sizes, some behind the camera; shadows of every kind, fog, lights with and without a
/// range.
constexpr const char* kBandsScene =
    R"({"camera": {"eye": [3, 2, 5], "target": [0, 0.5, 0], "fov_y": 60}, "background": [0, 0, 0.25], "ambient": 0.1,
  "fog": {"mode": "exp2", "density": [0.05, 0.02, 0.01], "color": [0.2, 0.3, 0.4]},
  "materials": {"m": {"diffuse": [0.6, 0.5, 0.4], "specular": 0.5, "shininess": 32}, "e": {"emission": [0.2, 0.1, 0]}},
  "objects": [{"primitive": "plane", "scale": 20, "segments": 9, "material": "m"}, {"primitive": "sphere", "translate": [0, 1, 0], "material": "m"},
              {"primitive": "torus", "translate": [1, 0.5, 2], "rotate": [60, 0, 20], "material": "e"}, {"primitive": "box", "translate": [0, 0, 9], "material": "m"}],
  "lights": [{"type": "directional", "direction": [-1, -2, -1], "intensity": 0.5, "shadow": true, "angle": 3},
             {"type": "point", "position": [1, 2, 2], "radius": 0.1, "range": 4, "shadow": true, "color": [1, 0.5, 0.2]},
             {"type": "spot", "position": [-2, 4, 2], "target": [0, 0, 0], "cutoff": 40, "exponent": 4, "shadow": true}],
  "light_fields": [{"count": 200, "seed": 3, "min": [-4, 0, -4], "max": [4, 2, 4], "range": 0.8, "intensity": 0.5}]})";

const std::vector<Aov> kAllLayers{Aov::kPosition, Aov::kNormal,     Aov::kDepth,  Aov::kDiffuse,
                                  Aov::kMaterial, Aov::kLightCount, Aov::kShadow, Aov::kShadingCount};

/// Renders in one piece and in bands of several heights.
void expectSameInBands(const Scene& scene, RenderSettings settings) {
  Stats stats;
  settings.band_height = 1 << 20;
  const Image whole = renderScene(testDevice(), scene, settings, stats);
  for (const int height : {13, 64, 81}) {
    settings.band_height = height;
    const Image image = renderScene(testDevice(), scene, settings, stats);
    ASSERT_EQ(image.height, whole.height);
    ASSERT_EQ(image.channels, whole.channels);
    ASSERT_EQ(image.pixels, whole.pixels) << "bands of " << height << " rows";
  }
}

TEST(Bands, TheirHeightChangesNoPicture) {
  const Scene scene = sceneFromJson(kBandsScene);
  expectSameInBands(scene, settingsFor(scene, {100, 150}));
}

TEST(Bands, TheirHeightChangesNoShadowOrLayerByAnyMethod) {
  const Scene scene = sceneFromJson(kBandsScene);
  RenderSettings settings = settingsFor(scene, {100, 150});
  settings.aovs = kAllLayers;
  for (const auto method : {ShadowMethod::kHard, ShadowMethod::kPcf, ShadowMethod::kSoft,
                            ShadowMethod::kExact, ShadowMethod::kSoftExact, ShadowMethod::kAuto}) {
    settings.shade.shadows = method;
    expectSameInBands(scene, settings);
  }
}

TEST(Bands, TheirHeightChangesNoSumOfSamplesWithLayers) {
  const Scene scene = sceneFromJson(kBandsScene);
  RenderSettings settings = settingsFor(scene, {100, 90});
  settings.samples = 3;
  settings.exposure = 0.5f;
  settings.aovs = kAllLayers;
  expectSameInBands(scene, settings);
  settings.sample_shading = SampleShading::kAll;
  expectSameInBands(scene, settings);
}

TEST(Bands, TheirHeightChangesNoCrop) {
  const Scene scene = sceneFromJson(kBandsScene);
  RenderSettings settings = settingsFor(scene, {130, 170});
  settings.crop = Crop{21, 37, 90, 121};
  expectSameInBands(scene, settings);
}

TEST(Bands, TheirHeightChangesNoGouraudOrFlatPicture) {
  const Scene scene = sceneFromJson(kBandsScene);
  RenderSettings settings = settingsFor(scene, {100, 150});
  for (const Shading shading : {Shading::kGouraud, Shading::kFlat}) {
    settings.shading = shading;
    expectSameInBands(scene, settings);
  }
}

TEST(Bands, CountsAreThoseOfOnePiece) {
  const Scene scene = sceneFromJson(kBandsScene);
  RenderSettings settings = settingsFor(scene, {130, 300});
  settings.crop = Crop{21, 37, 90, 223};
  settings.samples = 2;
  settings.count_lights = true;
  settings.sample_shading = SampleShading::kAll;
  Stats whole, bands;
  settings.band_height = 1 << 20;
  renderScene(testDevice(), scene, settings, whole);
  settings.band_height = kBinSize;
  renderScene(testDevice(), scene, settings, bands);
  // Rectangles of shadow maps that grow from band to band leave their old places empty.
  for (Stats* stats : {&whole, &bands})
    std::erase_if(stats->counts, [](const auto& count) { return count.first == "shadow_bytes"; });
  EXPECT_EQ(bands.counts, whole.counts);
  EXPECT_EQ(bands.width, 90);
  EXPECT_EQ(bands.height, 223);
  EXPECT_LT(bands.device_bytes, whole.device_bytes);
}

TEST(Bands, ComeFromTheTopDownAndEachPassIsReported) {
  const Scene scene = sceneFromJson(kBandsScene);
  RenderSettings settings = settingsFor(scene, {40, 150});
  settings.samples = 2;
  settings.band_height = 64;
  std::vector<std::pair<int, int>> passes;
  settings.on_pass = [&](int done, int all) { passes.emplace_back(done, all); };
  std::vector<int> heights;
  Stats stats;
  renderBands(
      testDevice(), scene, settings, [&](const Image& rows) { heights.push_back(rows.height); }, stats);
  EXPECT_EQ(heights, (std::vector<int>{64, 64, 22}));
  EXPECT_EQ(passes, (std::vector<std::pair<int, int>>{{64, 150}, {128, 150}, {150, 150}}));
  passes.clear();
  settings.sample_shading = SampleShading::kAll;
  renderBands(
      testDevice(), scene, settings, [](const Image&) {}, stats);
  EXPECT_EQ(passes, (std::vector<std::pair<int, int>>{
                        {64, 300}, {128, 300}, {192, 300}, {256, 300}, {278, 300}, {300, 300}}));
}

TEST(BandHeight, IsAsFewBandsOfWholeBinsAsFitTheBudget) {
  EXPECT_EQ(bandHeight({1280, 720}, 100), 768);
  EXPECT_EQ(bandHeight({1, 1}, 100), kBinSize);
  for (const std::size_t per_pixel : {60, 100, 250})
    for (const glm::ivec2& size : {glm::ivec2(16384, 16384), {32768, 30000}, {4096, 4096}, {100, 32768}}) {
      const int height = bandHeight(size, per_pixel);
      EXPECT_EQ(height % kBinSize, 0);
      const std::size_t bytes = per_pixel * size.x * std::min(height, size.y);
      EXPECT_TRUE(bytes <= kBandBytes || height == kBinSize) << size.x << "x" << size.y;
    }
}

TEST(Bands, AWidePictureHasNoSeamsAndTakesNoMoreThanABand) {
  const Scene scene = sceneFromJson(kBandsScene);
  RenderSettings settings = settingsFor(scene, {16384, 160});
  settings.camera.fov_y = 0.02;
  Stats whole, bands;
  const Image image = renderScene(testDevice(), scene, settings, whole);
  settings.band_height = kBinSize;
  std::size_t place = 0;
  renderBands(
      testDevice(), scene, settings,
      [&](const Image& rows) {
        ASSERT_LE(place + rows.pixels.size(), image.pixels.size());
        EXPECT_TRUE(std::equal(rows.pixels.begin(), rows.pixels.end(), image.pixels.begin() + place));
        place += rows.pixels.size();
      },
      bands);
  EXPECT_EQ(place, image.pixels.size());
  // Of the buffers, those of pixels grow with the band alone.
  EXPECT_EQ(bands.counts, whole.counts);
  EXPECT_GT(whole.device_bytes - bands.device_bytes,
            std::size_t(16384) * (160 - kBinSize) * 12 * sizeof(float));
}

}  // namespace
}  // namespace luciole::test
