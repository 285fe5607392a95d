#include "render/measure_exposure.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "render_json.hpp"

namespace luciole::test {
namespace {

/// Surfaces in the middle of an empty view; `gain` multiplies every light.
std::string dimOrBright(double gain, const std::string& background = "0") {
  const auto times = [&](double value) { return std::to_string(value * gain); };
  return R"({"camera": {"eye": [3, 2, 5], "target": [0, 0.5, 0]}, "background": )" + background +
         R"(, "ambient": )" + times(0.125) + R"(,
    "objects": [{"primitive": "sphere", "translate": [0, 1, 0]}, {"primitive": "box"}],
    "lights": [{"type": "directional", "direction": [-1, -2, -1], "shadow": true, "intensity": )" +
         times(0.5) + R"(}, {"type": "point", "position": [1, 2, 2], "range": 4, "intensity": )" + times(2) +
         "}]}";
}

double measured(const Scene& scene, const RenderSettings& settings) {
  Stats stats;
  return measureExposure(testDevice(), scene, settings, stats);
}

double measured(const std::string& json) {
  const Scene scene = sceneFromJson(json);
  return measured(scene, settingsFor(scene, {96, 54}));
}

TEST(MeasureExposure, BringsAnEvenlyBrightSurfaceToMiddleGrey) {
  // 0.045 is two stops below 0.18. As for suitableExposure: half a bin and half a hundredth.
  EXPECT_NEAR(measured(R"({"camera": {"eye": [0, 0, 2], "target": [0, 0, 0]}, "lights": [],
    "materials": {"lamp": {"diffuse": 0, "emission": 0.045}}, "objects": [{"primitive": "sphere", "material": "lamp"}]})"),
              2, std::log2(1 + 1.0 / 256) + 0.005 + 1e-9);
}

TEST(MeasureExposure, IsOfSurfacesNotOfTheBackground) {
  const double stops = measured(dimOrBright(1));
  EXPECT_NE(stops, 0);
  EXPECT_EQ(measured(dimOrBright(1, "50")), stops);
}

TEST(MeasureExposure, FollowsTheLights) {
  // All lights four times as strong: products by powers of two are exact, so every luminance is.
  EXPECT_NEAR(measured(dimOrBright(4)), measured(dimOrBright(1)) - 2, 1e-9);
}

TEST(MeasureExposure, OfDarknessIsZero) {
  EXPECT_EQ(measured(dimOrBright(0)), 0);
  EXPECT_EQ(
      measured(R"({"camera": {"eye": [0, 0, 2], "target": [0, 0, 0]}, "objects": [], "background": 3})"), 0);
}

TEST(MeasureExposure, IsThatOfTheWholePictureWhateverPartOrSizeIsMade) {
  const Scene scene = sceneFromJson(dimOrBright(1));
  RenderSettings settings = settingsFor(scene, {320, 180});
  const double stops = measured(scene, settings);
  settings.crop = Crop{10, 20, 30, 40};
  settings.samples = 4;
  settings.exposure = 3;
  settings.band_height = 16;
  settings.aovs = {Aov::kNormal, Aov::kDepth};
  settings.count_lights = true;
  EXPECT_EQ(measured(scene, settings), stops);
  settings.size = {640, 360};
  EXPECT_EQ(measured(scene, settings), stops);
}

TEST(MeasureExposure, OfAGBufferIsThatOfItsPicture) {
  const Scene scene = sceneFromJson(dimOrBright(1));
  const RenderSettings settings = settingsFor(scene, {100, 70});
  Stats stats;
  const GBuffer gbuffer = rasterizeScene(nullptr, scene, settings, stats);
  EXPECT_EQ(measureExposure(shadeGBuffer(testDevice(), scene, gbuffer, settings, stats), gbuffer),
            measured(scene, settings));
}

TEST(MeasureExposure, IsAStageAndLeavesThePicturesOwnCountsAlone) {
  const Scene scene = sceneFromJson(dimOrBright(1));
  RenderSettings settings = settingsFor(scene, {96, 54});
  Stats with, without;
  measureExposure(testDevice(), scene, settings, with);
  EXPECT_GT(stageTime(with, Stage::kMeasureExposure), 0);
  EXPECT_EQ(stageTime(with, Stage::kShade), 0);
  renderScene(testDevice(), scene, settings, with);
  renderScene(testDevice(), scene, settings, without);
  EXPECT_EQ(with.counts, without.counts);
}

}  // namespace
}  // namespace luciole::test
