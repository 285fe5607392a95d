#include "render/fog_cull.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "render_json.hpp"

namespace luciole::test {
namespace {

// Half of the finest 8-bit sRGB step, in linear light.
constexpr double kHalfStep = 0.5 / 255 / 12.92;

double share(const Fog& fog, double z) {
  switch (fog.mode) {
    case FogMode::kNone:
      return 1;
    case FogMode::kLinear:
      return std::min(1.0, std::max(0.0, (fog.end - z) / (double(fog.end) - fog.start)));
    case FogMode::kExp:
      return std::exp(-double(fog.density.z) * z);
    case FogMode::kExp2:
      return std::exp(-std::pow(fog.density.z * z, 2));
  }
  return 1;
}

TEST(FogCull, LimitIsWhereHalfAStepIsLeft) {
  for (const FogMode mode : {FogMode::kLinear, FogMode::kExp, FogMode::kExp2}) {
    Fog fog;
    fog.mode = mode;
    fog.density = {0.3f, 0.2f, 0.1f};  // the thinnest channel decides
    fog.start = 5;
    fog.end = 50;
    // Solving for z and inserting again: a handful of double operations and logarithms.
    EXPECT_NEAR(share(fog, fogLimit(fog, 1)), kHalfStep, kHalfStep * 1e-9) << int(mode);
    EXPECT_NEAR(share(fog, fogLimit(fog, 4)), kHalfStep / 4, kHalfStep * 1e-9) << int(mode);
  }
}

TEST(FogCull, WithoutFogOrDensityNothingIsHidden) {
  Fog fog;
  EXPECT_TRUE(std::isinf(fogLimit(fog, 1)));
  fog.mode = FogMode::kExp;
  fog.density = {1, 1, 0};
  EXPECT_TRUE(std::isinf(fogLimit(fog, 1)));
}

std::string rowScene(const char* background) {
  return fmt::format(
      R"({{"camera": {{"eye": [0, 0, 0], "target": [0, 0, -1], "far": 500}}, "background": [{}],
  "fog": {{"mode": "exp", "density": 0.5, "color": [0.5, 0.6, 0.7]}},
  "lights": [{{"type": "directional", "direction": [0, 0, -1]}}],
  "objects": [{{"primitive": "box", "translate": [0, 0, -3]}}, {{"primitive": "box", "translate": [0, 5, -100]}},
              {{"primitive": "box", "translate": [0, 2, -10]}}]}})",
      background);
}

TEST(FogCull, HidesOnlyObjectsWhollyBeyondTheLimit) {
  const Scene scene = sceneFromJson(rowScene("0.5, 0.6, 0.7"));
  EXPECT_EQ(objectsInSight(scene, cameraView(scene.cameras.front(), {64, 64}), 0),
            (std::vector<std::uint32_t>{0, 2}));
}

TEST(FogCull, BrightEmittersShineThroughMoreFog) {
  // A box that hides at 17 m and more: -ln(1.5e-4) / 0.5 = 17.6 m. A thousand times as bright it takes
  // ln(1000) / 0.5 = 13.8 m more.
  Scene scene = sceneFromJson(rowScene("0.5, 0.6, 0.7"));
  scene.objects[1].object_to_world[3] = {0, 0, -25, 1};
  const View view = cameraView(scene.cameras.front(), {64, 64});
  EXPECT_EQ(objectsInSight(scene, view, 0).size(), 2u);
  scene.materials.front().emission = {1000, 0, 0};
  EXPECT_EQ(objectsInSight(scene, view, 0).size(), 3u);
}

TEST(FogCull, KeepsSilhouettesBeforeAnotherBackground) {
  const Scene scene = sceneFromJson(rowScene("0, 0, 0"));
  EXPECT_EQ(objectsInSight(scene, cameraView(scene.cameras.front(), {64, 64}), 0).size(), 3u);
}

TEST(FogCull, HiddenObjectsWouldNotHaveChangedAnEightBitPicture) {
  const Scene scene = sceneFromJson(rowScene("0.5, 0.6, 0.7"));
  RenderSettings settings;
  settings.size = {128, 128};
  settings.camera = scene.cameras.front();
  Stats stats;
  const Image culled = renderScene(testDevice(), scene, settings, stats);
  Scene all = scene;
  all.background.x += 0.001f;  // another background, so everything is drawn
  const Image drawn = renderScene(testDevice(), all, settings, stats);
  for (std::size_t i = 0; i < culled.pixels.size(); ++i) {
    if (drawn.pixels[i] == all.background[int(i % 3)]) continue;
    ASSERT_NEAR(culled.pixels[i], drawn.pixels[i], kHalfStep);
  }
}

}  // namespace
}  // namespace luciole::test
