// An environment in a picture: as the background, and as light.
#include "render/sky_background.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "luciole/pose.hpp"
#include "reference/reference.hpp"
#include "reference/reference_picture.hpp"
#include "render/light_counts.hpp"
#include "render/render.hpp"
#include "render_json.hpp"

namespace luciole::test {
namespace {

/// A coloured sky with a bright side.
std::shared_ptr<const Sky> coloredSky(int height) {
  std::vector<float> texels;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < 2 * height; ++x) {
      const float bright = x > height && x < height + 4 && y < height / 2 ? 8.0f : 0.0f;
      texels.insert(texels.end(),
                    {0.2f + bright, float(x) / float(2 * height), float(y) / float(height) + bright});
    }
  std::vector<Warning> warnings;
  return makeSky(2 * height, height, texels, "sky", warnings);
}

Scene skyScene(std::uint32_t count, int height = 64) {
  Scene scene = sceneFromJson(R"({"camera": {"eye": [3, 2, 5], "target": [0, 0.8, 0], "fov_y": 60},
    "materials": {"m": {"diffuse": [0.6, 0.5, 0.4], "specular": 0.5, "shininess": 20}},
    "objects": [{"primitive": "plane", "scale": 4, "material": "m"},
                {"primitive": "sphere", "translate": [0, 1, 0], "material": "m"}]})");
  scene.lights.clear();
  LightSource sky;
  sky.sky = coloredSky(height);
  sky.count = count;
  sky.rotate = 0.7;
  sky.radiance = {1, 0.5f, 2};
  scene.sources = {sky};
  addSourceLights(scene);
  return scene;
}

RenderSettings skySettings(const Scene& scene, glm::ivec2 size, int samples = 1) {
  RenderSettings settings;
  settings.size = size;
  settings.camera = scene.cameras.front();
  settings.samples = samples;
  return settings;
}

double worstDifference(const Image& picture, const std::vector<glm::dvec3>& truth) {
  double worst = 0;
  for (std::size_t i = 0; i < truth.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c)
      worst = std::max(worst,
                       std::abs(double(picture.pixels[i * picture.channels.size() + c]) - truth[i][int(c)]) /
                           std::max(1.0, truth[i][int(c)]));
  return worst;
}

TEST(Environment, PictureIsTheReferencesForEverySampleCountAndCamera) {
  Scene scene = skyScene(40);
  for (const int samples : {1, 4})
    for (const bool parallel : {false, true}) {
      RenderSettings settings = skySettings(scene, {93, 48}, samples);
      settings.camera.orthographic = parallel;
      settings.camera.half_height = 3;
      settings.camera.shift = {0.2, -0.1};
      settings.shade.shadows = ShadowMethod::kOff;
      settings.sample_shading = SampleShading::kAll;
      Stats stats;
      const Image ours = renderScene(testDevice(), scene, settings, stats);
      const View view = cameraView(settings.camera, settings.size);
      const std::vector<glm::ivec2> pixels = allPixels(settings.size);
      const std::vector<glm::dvec3> truth =
          referencePicture(scene, view, settings.shading, samples, pixels, {.model = settings.shade.model});
      // A sum of 40 lights: 40 operations each of 2^-24 of a term, and the lobe's power: 4 · 20 · log2 e
      // more.
      EXPECT_LT(worstDifference(ours, truth), (2 * 40 + 4 * 20 * 1.45) * 0x1p-24) << samples << parallel;
    }
}

TEST(Environment, BackgroundIsTheSameWithAllSamplesShadedAndInLayersAndParts) {
  Scene scene = skyScene(16);
  RenderSettings settings = skySettings(scene, {80, 45}, 4);
  settings.light_groups = true;
  Stats stats;
  const Image shared = renderScene(testDevice(), scene, settings, stats);
  settings.sample_shading = SampleShading::kAll;
  const Image all = renderScene(testDevice(), scene, settings, stats);
  settings.crop = Crop{16, 8, 40, 30};
  settings.sample_shading = SampleShading::kShared;
  const Image crop = renderScene(testDevice(), scene, settings, stats);
  const std::size_t channels = shared.channels.size();
  ASSERT_EQ(channels, 9u);  // the picture, its lights and the rest
  std::size_t bare = 0;
  for (std::size_t i = 0; i < shared.pixels.size(); i += channels) {
    // Groups add up to the picture: each sum of 4 samples rounds a few times.
    for (std::size_t c = 0; c < 3; ++c)
      EXPECT_NEAR(shared.pixels[i + c], shared.pixels[i + 3 + c] + shared.pixels[i + 6 + c], 1e-6f * 12);
    if (shared.pixels[i + 3] != 0) continue;
    ++bare;
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(shared.pixels[i + c], all.pixels[i + c], 1e-5);
  }
  EXPECT_GT(bare, 300u);
  for (int y = 0; y < 30; ++y)
    for (int x = 0; x < 40; ++x)
      for (std::size_t c = 0; c < 3; ++c)
        EXPECT_EQ(crop.pixels[std::size_t(y * 40 + x) * channels + c],
                  shared.pixels[std::size_t((y + 8) * 80 + x + 16) * channels + c]);
}

TEST(Environment, IsNoPartOfPicturesWithAlpha) {
  Scene scene = skyScene(16);
  RenderSettings settings = skySettings(scene, {40, 30});
  settings.alpha = true;
  Stats stats;
  const Image picture = renderScene(testDevice(), scene, settings, stats);
  std::size_t bare = 0;
  for (std::size_t i = 0; i < picture.pixels.size(); i += 4)
    if (picture.pixels[i + 3] == 0) {
      ++bare;
      EXPECT_EQ(picture.pixels[i] + picture.pixels[i + 1] + picture.pixels[i + 2], 0);
    }
  EXPECT_GT(bare, 50u);
}

TEST(Environment, FarTexelsAreAveraged) {
  // A sky of lines a texel wide, seen through pixels of eight texels: grey, not lines.
  std::vector<float> texels;
  for (int y = 0; y < 512; ++y)
    for (int x = 0; x < 1024; ++x) texels.insert(texels.end(), 3, float(x % 2));
  std::vector<Warning> warnings;
  Scene scene;
  LightSource sky;
  sky.sky = makeSky(1024, 512, texels, "lines", warnings);
  scene.sources = {sky};
  scene.cameras = {Camera{.fov_y = 1.2}};
  Stats stats;
  const Image picture = renderScene(testDevice(), scene, skySettings(scene, {40, 25}), stats);
  for (const float value : picture.pixels) EXPECT_NEAR(value, 0.5, 0.02);
}

TEST(Environment, ThatTurnsByKeysIsTheOneThatIsTurned) {
  Scene moving = skyScene(64), still = skyScene(64);
  LightMotion motion;
  motion.rotate = {Interpolation::kLinear, {{1, {0, 0, 0, 0}}, {11, {90, 0, 0, 0}}}};
  moving.animation.sources = {motion};
  poseScene(moving, 6);
  still.sources[0].rotate = glm::radians(45.0);
  addSourceLights(still);
  EXPECT_EQ(moving.lights, still.lights);
}

TEST(LightCounts, ChosenOnesMissNoMoreThanAllowed) {
  for (const double allowed : {0.03, 0.01}) {
    Scene scene = skyScene(64);
    RenderSettings settings = skySettings(scene, {96, 54});
    settings.shade.shadows = ShadowMethod::kExact;
    settings.shade.light_error = float(allowed);
    for (Light& light : scene.lights) light.shadow = true;
    scene.sources[0].shadow = true;
    Stats stats;
    const double estimate = chooseLightCounts(testDevice(), scene, settings, stats, nullptr);
    EXPECT_LE(estimate, allowed);
    const std::uint32_t chosen = scene.sources[0].count;
    settings.shade.light_error = 0;
    const Image few = renderScene(testDevice(), scene, settings, stats);
    setLightCounts(scene, 64 * chosen);
    const Image many = renderScene(testDevice(), scene, settings, stats);
    std::vector<double> errors;
    for (std::size_t i = 0; i < few.pixels.size(); i += 3) {
      double worst = 0;
      for (std::size_t c = i; c < i + 3; ++c)
        worst = std::max(worst,
                         std::abs(double(few.pixels[c]) - many.pixels[c]) / std::max(1.0f, many.pixels[c]));
      errors.push_back(worst);
    }
    std::sort(errors.begin(), errors.end());
    const double missed = errors[std::size_t(0.99 * double(errors.size() - 1))];
    RecordProperty("chosen", int(chosen));
    RecordProperty("estimate_over_truth", std::to_string(estimate / missed));
    EXPECT_LE(missed, allowed) << chosen;
    EXPECT_GT(missed, allowed / 40) << "not for nothing: " << chosen;
  }
}

}  // namespace
}  // namespace luciole::test
