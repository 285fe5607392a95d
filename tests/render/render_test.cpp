#include "render/render.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>

#include "luciole/error.hpp"
#include "reference/reference.hpp"
#include "render_json.hpp"
#include "setting.hpp"

namespace luciole::test {
namespace {

TEST(SamplePoint, SingleSampleIsThePixelsCentre) { EXPECT_EQ(samplePoint(0, 1), glm::dvec2(0.5)); }

TEST(SamplePoint, SamplesFillEveryRowAndColumnOnceForPowersOfTwo) {
  for (const int count : {2, 4, 8, 16, 64}) {
    std::vector<int> columns(count), rows(count);
    for (int i = 0; i < count; ++i) {
      const glm::dvec2 p = samplePoint(i, count);
      ++columns.at(int(p.x * count));
      ++rows.at(int(p.y * count));
    }
    EXPECT_EQ(columns, std::vector<int>(count, 1));
    EXPECT_EQ(rows, std::vector<int>(count, 1));
  }
}

constexpr const char* kRenderScene =
    R"({"camera": {"eye": [3, 2, 5], "target": [0, 0.5, 0]}, "ambient": [0.1, 0.1, 0.1],
  "fog": {"mode": "exp", "density": [0.05, 0.02, 0.01], "color": [0.2, 0.3, 0.4]},
  "materials": {"m": {"diffuse": [0.6, 0.5, 0.4], "specular": 0.5, "shininess": 32}},
  "objects": [{"primitive": "plane", "scale": 10, "material": "m"}, {"primitive": "sphere", "translate": [0, 1, 0], "material": "m"}],
  "lights": [{"type": "directional", "direction": [-1, -2, -1], "color": [0.5, 0.5, 0.5]},
             {"type": "point", "position": [1, 2, 2], "range": 4, "ambient": [0.1, 0, 0], "diffuse": [1, 0.5, 0.2]},
             {"type": "spot", "position": [-2, 4, 2], "target": [0, 0, 0], "inner_cone": 10, "outer_cone": 30, "attenuation": [0, 0, 0.1]}]})";

TEST(Render, AgreesWithTheDoublePrecisionReference) {
  const Scene scene = sceneFromJson(kRenderScene);
  RenderSettings settings;
  settings.size = {160, 90};
  settings.camera = scene.cameras.front();
  for (const Model model : {Model::kPhong, Model::kBlinnPhong}) {
    settings.shade.model = model;
    Stats stats;
    const GBuffer gbuffer = rasterizeScene(nullptr, scene, settings, stats);
    const Image ours = renderScene(testDevice(), scene, settings, stats);
    const Image truth = referenceShade(scene, gbuffer, {.model = model});
    ASSERT_EQ(ours.pixels.size(), truth.pixels.size());
    // About 40 roundings of 2^-24 between a light and the sum, on the largest of three lights' terms below 2;
    // the lobe's power multiplies its argument's error (4·2^-24) by the exponent 32 and by log2 e.
    const double tolerance = 2 * (40 + 4 * 32 * 1.4427) * std::exp2(-24);
    double worst = 0;
    for (std::size_t i = 0; i < ours.pixels.size(); ++i)
      worst = std::max(worst, std::abs(double(ours.pixels[i]) - truth.pixels[i]));
    EXPECT_LE(worst, tolerance);
  }
}

/// A device that lights all pictures generally.
void openGeneral(OpenedDevice& device) {
  const Setting setting("LUCIOLE_GENERAL", "1");
  openDevice("", device);
}

TEST(Render, WhereAllPicturesAreLitGenerallyScenesShareAProgramAndHaveTheBitsOfTheirOwn) {
  Scene foggy = sceneFromJson(kRenderScene), matte = foggy, mapped = foggy;
  matte.fog = {};
  for (Material& material : matte.materials) material.specular = {};
  for (Light& light : mapped.lights) light.shadow = true;
  RenderSettings settings;
  settings.size = {64, 36};
  settings.camera = foggy.cameras.front();
  OpenedDevice device;
  openGeneral(device);
  const auto same = [&](const Scene& scene) {
    Stats stats;
    return renderScene(device, scene, settings, stats).pixels ==
           renderScene(testDevice(), scene, settings, stats).pixels;
  };
  EXPECT_TRUE(same(foggy));
  const std::size_t programs = device.programs.size();
  EXPECT_TRUE(same(matte));
  EXPECT_EQ(device.programs.size(), programs);
  // Shadow maps aren't in it: that picture has a program of its own, and those after it have not.
  settings.shade.shadows = ShadowMethod::kHard;
  EXPECT_TRUE(same(mapped));
  EXPECT_GT(device.programs.size(), programs);
  settings.shade.shadows = ShadowMethod::kAuto;
  const std::size_t more = device.programs.size();
  EXPECT_TRUE(same(matte));
  EXPECT_EQ(device.programs.size(), more);
}

// Layers leave out emission, and the illuminance fog and models, too. Vertices have no fog yet.
TEST(Render, LayersAndVerticesThatAreLitGenerallyHaveTheBitsOfTheirOwnPrograms) {
  Scene scene = sceneFromJson(kRenderScene);
  for (Material& material : scene.materials) material.emission = {0.3f, 0.2f, 0.1f};
  OpenedDevice device;
  openGeneral(device);
  RenderSettings settings;
  settings.size = {64, 36};
  settings.camera = scene.cameras.front();
  const auto expectSame = [&] {
    Stats stats;
    const Image general = renderScene(device, scene, settings, stats);
    const Image own = renderScene(testDevice(), scene, settings, stats);
    ASSERT_EQ(general.pixels.size(), own.pixels.size());
    const std::size_t channels = own.channels.size();
    for (std::size_t channel = 0; channel < channels; ++channel) {
      std::size_t different = 0;
      for (std::size_t i = channel; i < own.pixels.size(); i += channels)
        different += !(general.pixels[i] == own.pixels[i]);
      EXPECT_EQ(different, 0u) << "pixels of channel " << own.channels[channel];
    }
  };
  settings.aovs = {Aov::kAmbient,  Aov::kDiffuseLight, Aov::kSpecularLight,
                   Aov::kEmission, Aov::kFog,          Aov::kIlluminance};
  expectSame();
  scene.materials.front().model = Model::kToon;
  expectSame();
  settings.aovs = {};
  settings.shading = Shading::kGouraud;
  expectSame();
}

TEST(Render, PairsAreCountedInAStageOfTheirOwnAndOnlyWhenAskedFor) {
  const Scene scene = sceneFromJson(kRenderScene);
  RenderSettings settings;
  settings.size = {64, 48};
  settings.camera = scene.cameras.front();
  for (const bool asked : {false, true}) {
    settings.count_lights = asked;
    Stats stats;
    renderScene(testDevice(), scene, settings, stats);
    EXPECT_EQ(countOf(stats, "pixel_lights_evaluated") > 0, asked);
    EXPECT_EQ(countOf(stats, "pixel_lights_in_range") > 0, asked);
    EXPECT_EQ(std::any_of(stats.stages.begin(), stats.stages.end(),
                          [](const auto& stage) { return stage.first == Stage::kCountLights; }),
              asked);
  }
}

TEST(Render, ListLengthLayerHoldsWhatIsEvaluatedAndAtLeastWhatIsInRange) {
  const Scene scene = sceneFromJson(R"({"camera": {"eye": [0, 0, 3], "target": [0, 0, 0]},
    "objects": [{"primitive": "plane", "rotate": [90, 0, 0], "scale": 20}],
    "light_fields": [{"count": 60, "min": [-2, -2, 0.1], "max": [2, 2, 0.5], "range": 0.6}]})");
  for (const Culling culling : {Culling::kNone, Culling::kTiles}) {
    for (const int tile : {4, 8, 16}) {
      RenderSettings settings;
      settings.size = {64, 48};  // whole tiles, all covered: every pixel of a list is one of the picture
      settings.camera = scene.cameras.front();
      settings.aovs = {Aov::kLightCount, Aov::kListLength};
      settings.shade.culling = culling;
      settings.shade.tile_size = tile;
      settings.count_lights = true;
      Stats stats;
      const Image image = renderScene(testDevice(), scene, settings, stats);
      double evaluated = 0, largest = 0;
      for (std::size_t i = 0; i < image.pixels.size(); i += 5) {
        const float in_range = image.pixels[i + 3], length = image.pixels[i + 4];
        ASSERT_GE(length, in_range);
        evaluated += length;
        largest = std::max<double>(largest, length);
      }
      EXPECT_EQ(countOf(stats, "pixel_lights_evaluated"), evaluated);
      if (culling == Culling::kNone) {
        EXPECT_EQ(evaluated, 60.0 * 64 * 48);
      } else {
        EXPECT_LT(largest, 60);
      }
    }
  }
}

TEST(Render, LightCountLayerCountsTheLightsWhoseRangeHoldsThePoint) {
  // Of the last two lights one reaches a disc of the wall around its middle, the other not the wall.
  const std::string json = R"({"camera": {"eye": [0, 0, 3], "target": [0, 0, 0]},
    "objects": [{"primitive": "plane", "rotate": [90, 0, 0], "scale": 20}],
    "lights": [{"type": "directional", "direction": [0, 0, -1]}, {"type": "point", "position": [0, 0, 1]},
               {"type": "point", "position": [0, 0, 0.5], "range": 1},
               {"type": "point", "position": [0, 0, 1], "range": 0.5}]})";
  for (const Culling culling : {Culling::kNone, Culling::kTiles}) {
    const Image image = renderJson(json, {64, 48}, [&](RenderSettings& settings) {
      settings.aovs = {Aov::kPosition, Aov::kLightCount};
      settings.shade.culling = culling;
    });
    const std::size_t x = channelIndex(image, "P.X"), y = channelIndex(image, "P.Y"),
                      count = channelIndex(image, "light_count");
    for (std::size_t i = 0; i < image.pixels.size(); i += image.channels.size()) {
      const double distance2 = std::pow(image.pixels[i + x], 2) + std::pow(image.pixels[i + y], 2) + 0.25;
      // A float's rounding of a place a metre away moves its square by 2⁻²².
      if (std::abs(distance2 - 1) < 1e-6) continue;
      ASSERT_EQ(image.pixels[i + count], distance2 < 1 ? 3 : 2) << distance2;
    }
  }
}

TEST(Render, ShadowLayerIsOneWhereNoShadowedLightShines) {
  const std::string json = R"({"camera": {"eye": [0, 0, 3], "target": [0, 0, 0]},
    "objects": [{"primitive": "plane", "rotate": [90, 0, 0], "scale": 20}],
    "lights": [{"type": "directional", "direction": [0, 0, -1]},
               {"type": "point", "position": [0, 0, -1], "shadow": true}]})";
  const Image image =
      renderJson(json, {16, 16}, [](RenderSettings& settings) { settings.aovs = {Aov::kShadow}; });
  for (std::size_t i = 3; i < image.pixels.size(); i += 4) ASSERT_EQ(image.pixels[i], 1) << i / 4;
}

TEST(Render, UnlitSceneShowsDiffuseAndEmission) {
  const Image image = renderJson(R"({"lighting": false, "camera": {"eye": [0, 0, 3], "target": [0, 0, 0]},
    "materials": {"m": {"diffuse": [0.25, 0.5, 0.75], "emission": [0.125, 0, 0]}},
    "objects": [{"primitive": "box", "material": "m"}], "lights": [{"type": "directional", "direction": [0, 0, -1]}]})",
                                 {9, 9}, [](RenderSettings&) {});
  const std::size_t centre = 3 * (4 * 9 + 4);
  EXPECT_EQ(image.pixels[centre], 0.375f);
  EXPECT_EQ(image.pixels[centre + 1], 0.5f);
  EXPECT_EQ(image.pixels[centre + 2], 0.75f);
}

TEST(Render, MoreSamplesSmoothEdgesTowardsTheCoveredShare) {
  // The left half of an emissive square's pixel column is covered: with n samples the edge pixel is k/n
  // white.
  const std::string json =
      R"({"camera": {"eye": [0, 0, 2], "target": [0, 0, 0], "orthographic": 1}, "lighting": false,
    "objects": [{"primitive": "box", "translate": [-0.5, 0, 0], "scale": [1, 4, 0.1]}], "materials": {}})";
  const Image image = renderJson(json, {5, 5}, [](RenderSettings& settings) { settings.samples = 16; });
  const float inside = image.pixels[3 * (2 * 5 + 0)], edge = image.pixels[3 * (2 * 5 + 2)];
  // Pixel 2 spans x in [-0.2, 0.2] m, the box ends at 0: half of 16 samples, one per column of a 16th.
  EXPECT_NEAR(edge, inside * 0.5f, inside * 1e-6f);
}

TEST(Render, MovingCameraAndSceneFarAwayChangesNextToNothing) {
  const auto far = [](double offset) {
    return "{\"camera\": {\"eye\": [" + std::to_string(offset + 3) + ", 2, 5], \"target\": [" +
           std::to_string(offset) + ", 0.5, 0]}, " +
           "\"objects\": [{\"primitive\": \"sphere\", \"translate\": [" + std::to_string(offset) +
           ", 0.5, 0]}], " + "\"lights\": [{\"type\": \"point\", \"position\": [" +
           std::to_string(offset + 1) + ", 2, 2], \"range\": 9}]}";
  };
  const Image near_image = renderJson(far(0), {64, 36}, [](RenderSettings&) {});
  const Image far_image = renderJson(far(1e7), {64, 36}, [](RenderSettings&) {});
  // A double holds 10^7 m to 2 nm: 10^-9 of the distances here, far below a float's rounding, which may then
  // differ by an ulp in positions and, through the lighting, by some tens of ulps; a silhouette pixel may
  // flip where a sample lies on the edge.
  int differing = 0;
  for (std::size_t i = 0; i < near_image.pixels.size(); ++i)
    differing += std::abs(near_image.pixels[i] - far_image.pixels[i]) > 64 * std::exp2(-24);
  EXPECT_LE(differing, 3);
}

TEST(Render, CropOutsideThePictureIsRefused) {
  for (const Crop crop :
       {Crop{-1, 0, 2, 2}, {0, 0, 0, 1}, {60, 0, 5, 5}, {0, 0, 2147483647, 1}, {2147483647, 0, 1, 1}})
    EXPECT_THROW(renderJson(kRenderScene, {64, 36}, [&](RenderSettings& settings) { settings.crop = crop; }),
                 InputError);
}

}  // namespace
}  // namespace luciole::test
