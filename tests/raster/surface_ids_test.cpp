// Layers that say which objects and materials a pixel's samples see. Whether Cryptomattes are as their
// specification says tests/tools/cli/cryptomatte_test.py tells.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "image/cryptomatte.hpp"
#include "raster/surface_ids.hpp"
#include "render_json.hpp"

namespace luciole::test {
namespace {

using testing::ElementsAre;

constexpr const char* kThings =
    R"({"camera": {"eye": [3, 2, 5], "target": [0, 0.5, 0], "fov_y": 60}, "ambient": 0.5,
  "fog": {"mode": "exp", "density": 0.3, "color": 0.1}, "background": 0.1,
  "materials": {"stone": {"diffuse": 0.5}, "glass": {"diffuse": [0, 0, 1]}},
  "objects": [{"name": "ground", "primitive": "plane", "scale": 4, "material": "stone"},
              {"primitive": "sphere", "translate": [0, 1, 0], "material": "glass"}, {"primitive": "sphere", "translate": [1, 1, 1]},
              {"primitive": "box", "translate": [0, 0.5, 2], "material": "glass"}, {"name": "ground", "primitive": "cone", "translate": [2, 0, 0]},
              {"primitive": "box", "translate": [-40, 0.5, -70], "scale": 20}]})";

const std::vector<Aov> kSurfaceIds{Aov::kObjectId, Aov::kMaterialId, Aov::kCryptoObject,
                                   Aov::kCryptoMaterial};

std::size_t channelOf(const Image& image, const std::string& name) {
  return std::size_t(std::find(image.channels.begin(), image.channels.end(), name) - image.channels.begin());
}

/// The sum of a matte's coverages.
float covered(const Image& image, const float* pixel, const char* type_name) {
  const std::size_t first = channelOf(image, std::string(type_name) + "00.R");
  float sum = 0;
  for (int rank = 0; rank < kCryptomatteRanks; ++rank) sum += pixel[first + 2 * std::size_t(rank) + 1];
  return sum;
}

TEST(SurfaceIds, ObjectsAndMaterialsHaveNames) {
  const Scene scene = sceneFromJson(kThings);
  EXPECT_THAT(objectNames(scene), ElementsAre("ground", "sphere.1", "sphere.2", "box.3", "ground", "box.5"));
  EXPECT_THAT(materialNames(scene), ElementsAre("material.0", "glass", "stone"));
}

TEST(SurfaceIds, MattesCoverWhatIsCoveredAndChangeNoPicture) {
  const Scene scene = sceneFromJson(kThings);
  for (const auto& [samples, shading] :
       {std::pair{1, SampleShading::kShared}, std::pair{8, SampleShading::kShared},
        std::pair{4, SampleShading::kAll}}) {
    RenderSettings settings = settingsFor(scene, {130, 90});
    settings.samples = samples;
    settings.sample_shading = shading;
    settings.alpha = true;
    const Image plain = picture(scene, settings);
    settings.aovs = kSurfaceIds;
    const Image image = picture(scene, settings);
    const std::size_t step = image.channels.size();
    for (std::size_t i = 0; i < plain.pixels.size() / 4; ++i) {
      const float* pixel = image.pixels.data() + i * step;
      for (std::size_t c = 0; c < 4; ++c) ASSERT_EQ(pixel[c], plain.pixels[4 * i + c]);
      // Powers of two: samples lie at multiples of 1/256 pixel, by which both ways to draw them agree.
      ASSERT_EQ(covered(image, pixel, kCryptoObject), pixel[3]);
      ASSERT_EQ(covered(image, pixel, kCryptoMaterial), pixel[3]);
    }
  }
}

TEST(SurfaceIds, NumbersAreThoseOfTheNamesThatCoverAPixelOfOneSample) {
  const Scene scene = sceneFromJson(kThings);
  RenderSettings settings = settingsFor(scene, {130, 90});
  settings.aovs = kSurfaceIds;
  const Image image = picture(scene, settings);
  const std::vector<std::string> objects = objectNames(scene), materials = materialNames(scene);
  const std::size_t step = image.channels.size();
  std::vector<int> seen(objects.size() + 1);
  for (std::size_t i = 0; i < image.pixels.size(); i += step) {
    const auto value = [&](const char* channel) { return image.pixels[i + channelOf(image, channel)]; };
    const int object = int(value("object_id")), material = int(value("material_id"));
    ++seen[std::size_t(object) + 1];
    ASSERT_EQ(value("CryptoObject00.R"), object < 0 ? 0.0f : cryptomatteId(objects[std::size_t(object)]));
    ASSERT_EQ(value("CryptoMaterial00.R"),
              material < 0 ? 0.0f : cryptomatteId(materials[std::size_t(material)]));
    ASSERT_EQ(value("CryptoObject00.G"), object < 0 ? 0.0f : 1.0f);
  }
  // All are seen, the last, which the fog hides, too.
  for (const int pixels : seen) EXPECT_GT(pixels, 0);
}

// Without Cryptomattes they come from the G-buffer that is lit, not from another drawing of it.
TEST(SurfaceIds, NumbersOfOneSampleAreTheSameWithoutMattes) {
  Scene scene = sceneFromJson(kThings);
  for (const FogMode mode : {FogMode::kNone, FogMode::kExp})
    for (const Shading shading : {Shading::kPhong, Shading::kFlat}) {
      scene.fog.mode = mode;
      scene.materials[1].blended = true;
      scene.materials[1].alpha = 0.5f;
      RenderSettings settings = settingsFor(scene, {130, 90});
      settings.shading = shading;
      settings.aovs = kSurfaceIds;
      const Image with = picture(scene, settings);
      settings.aovs = {Aov::kObjectId, Aov::kMaterialId};
      const Image alone = picture(scene, settings);
      const std::size_t step = with.channels.size(), object = channelOf(with, "object_id");
      for (std::size_t i = 0; i < with.pixels.size() / step; ++i) {
        ASSERT_EQ(alone.pixels[5 * i + 3], with.pixels[i * step + object]);
        ASSERT_EQ(alone.pixels[5 * i + 4], with.pixels[i * step + channelOf(with, "material_id")]);
      }
    }
}

TEST(SurfaceIds, AreTheSameInBandsAndCrops) {
  const Scene scene = sceneFromJson(kThings);
  RenderSettings settings = settingsFor(scene, {130, 150});
  settings.aovs = kSurfaceIds;
  settings.samples = 4;
  settings.band_height = 1 << 20;
  const Image whole = picture(scene, settings);
  settings.band_height = 64;
  EXPECT_EQ(picture(scene, settings).pixels, whole.pixels);
  settings.crop = Crop{21, 37, 90, 101};
  const Image crop = picture(scene, settings);
  const std::size_t step = whole.channels.size();
  for (std::size_t y = 0; y < 101; ++y)
    for (std::size_t i = 0; i < 90 * step; ++i)
      ASSERT_EQ(crop.pixels[y * 90 * step + i], whole.pixels[((y + 37) * 130 + 21) * step + i]);
}

}  // namespace
}  // namespace luciole::test
