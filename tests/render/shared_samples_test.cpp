// Samples of a pixel that see the same surface are shaded once.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "render_json.hpp"

namespace luciole::test {
namespace {

constexpr const char* kBusyScene =
    R"({"camera": {"eye": [3, 2, 5], "target": [0, 0.5, 0], "fov_y": 60}, "background": [0, 0, 0.25], "ambient": 0.1,
  "fog": {"mode": "exp2", "density": [0.05, 0.02, 0.01], "color": [0.2, 0.3, 0.4]},
  "materials": {"m": {"diffuse": [0.6, 0.5, 0.4], "specular": 0.5, "shininess": 32}, "e": {"emission": [0.2, 0.1, 0]}},
  "objects": [{"primitive": "plane", "scale": 20, "segments": 9, "material": "m"}, {"primitive": "sphere", "translate": [0, 1, 0], "material": "m"},
              {"primitive": "torus", "translate": [1, 0.5, 2], "rotate": [60, 0, 20], "material": "e"}, {"primitive": "box", "translate": [0, 0, 9], "material": "m"}],
  "lights": [{"type": "directional", "direction": [-1, -2, -1], "intensity": 0.5, "shadow": true, "angle": 3},
             {"type": "point", "position": [1, 2, 2], "radius": 0.1, "range": 4, "shadow": true, "color": [1, 0.5, 0.2]},
             {"type": "spot", "position": [-2, 4, 2], "target": [0, 0, 0], "cutoff": 40, "exponent": 4, "shadow": true}],
  "light_fields": [{"count": 200, "seed": 3, "min": [-4, 0, -4], "max": [4, 2, 4], "range": 0.8, "intensity": 0.5}]})";

RenderSettings settingsOf(const Scene& scene, glm::ivec2 size, int samples, SampleShading shading) {
  RenderSettings settings = settingsFor(scene, size);
  settings.samples = samples;
  settings.sample_shading = shading;
  return settings;
}

double rootMeanSquare(const Image& a, const Image& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i)
    sum += (double(a.pixels[i]) - b.pixels[i]) * (double(a.pixels[i]) - b.pixels[i]);
  return std::sqrt(sum / double(a.pixels.size()));
}

TEST(SharedSamples, OneSampleIsThePictureWithoutThem) {
  const Scene scene = sceneFromJson(kBusyScene);
  EXPECT_EQ(picture(scene, settingsOf(scene, {100, 70}, 1, SampleShading::kShared)).pixels,
            picture(scene, settingsOf(scene, {100, 70}, 1, SampleShading::kAll)).pixels);
}

TEST(SharedSamples, AFlatColorIsThatOfOneSample) {
  // Light of one direction on a plane that fills the picture.
  const Scene scene = sceneFromJson(R"({"camera": {"eye": [0, 0, 3], "target": [0, 0, 0]}, "ambient": 0.1,
    "materials": {"m": {"diffuse": [0.7, 0.3, 0.1], "specular": 0}},
    "objects": [{"primitive": "plane", "rotate": [90, 0, 0], "scale": 20, "material": "m"}],
    "lights": [{"type": "directional", "direction": [0.3, 0, -1]}]})");
  const Image one = picture(scene, settingsOf(scene, {32, 32}, 1, SampleShading::kShared));
  for (const int samples : {2, 4, 16, 64})  // powers of two, so that weights are exact
    EXPECT_EQ(picture(scene, settingsOf(scene, {32, 32}, samples, SampleShading::kShared)).pixels,
              one.pixels);
}

TEST(SharedSamples, APixelIsTheMeanOfItsSurfacesByCoverage) {
  // A wall half a pixel wide that glows red, before a background of green.
  const Scene scene = sceneFromJson(R"({"background": [0, 1, 0],
    "camera": {"orthographic": 4, "eye": [0, 0, 3], "target": [0, 0, 0]},
    "materials": {"m": {"emission": [1, 0, 0], "diffuse": 0, "specular": 0}},
    "objects": [{"primitive": "box", "scale": [0.5, 20, 1], "material": "m"}]})");
  for (const int samples : {4, 16}) {
    RenderSettings settings = settingsOf(scene, {8, 8}, samples, SampleShading::kShared);
    settings.aovs = {Aov::kShadingCount};
    for (const bool alpha : {false, true}) {
      settings.alpha = alpha;
      const Image image = picture(scene, settings);
      const std::size_t step = image.channels.size(), count = channelIndex(image, "shading_count");
      float covered = 0;
      for (int x = 0; x < 8; ++x) {
        const float* pixel = image.pixels.data() + (3 * 8 + x) * step;
        covered += pixel[0];
        ASSERT_EQ(pixel[1], alpha ? 0.0f : 1.0f - pixel[0]);
        ASSERT_EQ(pixel[count], pixel[0] > 0 ? 1.0f : 0.0f);
        if (alpha) {
          ASSERT_EQ(pixel[3], pixel[0]);
        }
      }
      EXPECT_EQ(covered, 0.5f);  // a quarter of a pixel on either side of the middle
    }
  }
}

TEST(SharedSamples, ShadingCountOfWholeSamplesIsHowManySeeASurface) {
  const Scene scene = sceneFromJson(kBusyScene);
  RenderSettings settings = settingsOf(scene, {60, 40}, 4, SampleShading::kAll);
  settings.alpha = true;
  settings.aovs = {Aov::kShadingCount};
  const Image image = picture(scene, settings);
  const std::size_t count = channelIndex(image, "shading_count");
  for (std::size_t i = 0; i < image.pixels.size(); i += image.channels.size())
    ASSERT_EQ(image.pixels[i + count], 4 * image.pixels[i + 3]);
}

TEST(SharedSamples, AlphaIsThatOfWholeSamples) {
  const Scene scene = sceneFromJson(kBusyScene);
  RenderSettings settings = settingsOf(scene, {60, 40}, 16, SampleShading::kAll);
  settings.alpha = true;
  const Image all = picture(scene, settings);
  settings.sample_shading = SampleShading::kShared;
  const Image shared = picture(scene, settings);
  for (std::size_t i = 3; i < all.pixels.size(); i += 4) ASSERT_EQ(shared.pixels[i], all.pixels[i]) << i;
}

TEST(SharedSamples, TakeFewShadingsAndErrLittleMoreThanWholeOnes) {
  const Scene scene = sceneFromJson(kBusyScene);
  const glm::ivec2 size(200, 140);
  for (const Shading shading : {Shading::kPhong, Shading::kFlat, Shading::kGouraud}) {
    const auto image = [&](int samples, SampleShading how, Stats& stats) {
      RenderSettings settings = settingsOf(scene, size, samples, how);
      settings.shading = shading;
      settings.shade.shadows = ShadowMethod::kPcf;
      return renderScene(testDevice(), scene, settings, stats);
    };
    Stats of_truth, of_all, of_shared;
    const Image truth = image(256, SampleShading::kAll, of_truth);
    const Image all = image(16, SampleShading::kAll, of_all);
    const Image shared = image(16, SampleShading::kShared, of_shared);
    EXPECT_LT(4 * countOf(of_shared, "pixels_lit"), countOf(of_all, "pixels_lit"));
    EXPECT_LE(rootMeanSquare(truth, shared), 1.3 * rootMeanSquare(truth, all)) << int(shading);
  }
}

TEST(SharedSamples, LayersShowThePointOfTheFirstSample) {
  const Scene scene = sceneFromJson(kBusyScene);
  RenderSettings settings = settingsOf(scene, {60, 40}, 4, SampleShading::kAll);
  settings.aovs = {Aov::kPosition, Aov::kDiffuse};
  const Image all = picture(scene, settings);
  settings.sample_shading = SampleShading::kShared;
  const Image shared = picture(scene, settings);
  ASSERT_EQ(shared.channels, all.channels);
  const std::size_t diffuse = channelIndex(all, "diffuse.R");
  for (std::size_t i = 0; i < all.pixels.size(); i += all.channels.size())
    ASSERT_EQ(shared.pixels[i + diffuse], all.pixels[i + diffuse]);
}

TEST(SharedSamples, ACropIsACutOut) {
  const Scene scene = sceneFromJson(kBusyScene);
  RenderSettings settings = settingsOf(scene, {130, 90}, 8, SampleShading::kShared);
  settings.aovs = {Aov::kPosition, Aov::kShadingCount};
  const Image whole = picture(scene, settings);
  const std::size_t step = whole.channels.size();
  for (const Crop& crop :
       {Crop{0, 0, 70, 90}, Crop{21, 37, 50, 40}, Crop{129, 89, 1, 1}, Crop{0, 64, 130, 1}}) {
    settings.crop = crop;
    const Image part = picture(scene, settings);
    for (int y = 0; y < crop.height; ++y) {
      const auto row = whole.pixels.begin() + ((y + crop.y) * 130 + crop.x) * std::ptrdiff_t(step);
      ASSERT_TRUE(std::equal(row, row + crop.width * std::ptrdiff_t(step),
                             part.pixels.begin() + y * crop.width * std::ptrdiff_t(step)))
          << "row " << y << " of the crop at " << crop.x << ',' << crop.y;
    }
  }
}

TEST(SharedSamples, AShadowsEdgeIsAsSmoothAsWithWholeSamples) {
  // A box's shadow on a floor: one surface, on which light ends within a pixel.
  const Scene scene = sceneFromJson(R"({"camera": {"eye": [0, 6, 0.1], "target": [0, 0, 0]}, "ambient": 0.1,
    "objects": [{"primitive": "plane", "scale": 20}, {"primitive": "box", "translate": [0.3, 0.7, 0.2], "rotate": [0, 20, 0]}],
    "lights": [{"type": "directional", "direction": [-0.5, -1, -0.3], "shadow": true}]})");
  const auto image = [&](int samples, SampleShading how, Stats& stats) {
    RenderSettings settings = settingsOf(scene, {160, 120}, samples, how);
    settings.shade.shadow_limits.size = 2048;
    return renderScene(testDevice(), scene, settings, stats);
  };
  Stats of_truth, of_all, of_shared;
  const Image truth = image(256, SampleShading::kAll, of_truth), all = image(16, SampleShading::kAll, of_all),
              shared = image(16, SampleShading::kShared, of_shared);
  EXPECT_LE(rootMeanSquare(truth, shared), 1.3 * rootMeanSquare(truth, all));
  EXPECT_GT(countOf(of_shared, "refined_pixels"), 0u);
  EXPECT_LT(countOf(of_shared, "refined_pixels"), 160u * 120 / 10);
  EXPECT_LT(4 * countOf(of_shared, "pixels_lit"), countOf(of_all, "pixels_lit"));
}

TEST(SharedSamples, TilesAndCullingChangeNothing) {
  const Scene scene = sceneFromJson(kBusyScene);
  RenderSettings settings = settingsOf(scene, {130, 90}, 8, SampleShading::kShared);
  const Image wanted = picture(scene, settings);
  for (const int tile : {8, 16}) {
    settings.shade.tile_size = tile;
    EXPECT_EQ(picture(scene, settings).pixels, wanted.pixels);
  }
  settings.shade.culling = Culling::kNone;
  EXPECT_EQ(picture(scene, settings).pixels, wanted.pixels);
}

}  // namespace
}  // namespace luciole::test
