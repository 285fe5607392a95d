#include "lights/fog_cull.hpp"

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
  EXPECT_EQ(objectsInSight(scene, cameraView(scene.cameras.front(), {64, 64}), 0, Model::kPhong),
            (std::vector<std::uint32_t>{0, 2}));
}

TEST(FogCull, BrightEmittersShineThroughMoreFog) {
  // A box that hides at 17 m and more: -ln(1.5e-4) / 0.5 = 17.6 m. A thousand times as bright it takes
  // ln(1000) / 0.5 = 13.8 m more.
  Scene scene = sceneFromJson(rowScene("0.5, 0.6, 0.7"));
  scene.objects[1].object_to_world[3] = {0, 0, -25, 1};
  const View view = cameraView(scene.cameras.front(), {64, 64});
  EXPECT_EQ(objectsInSight(scene, view, 0, Model::kPhong).size(), 2u);
  scene.materials.front().emission = {1000, 0, 0};
  EXPECT_EQ(objectsInSight(scene, view, 0, Model::kPhong).size(), 3u);
}

TEST(FogCull, KeepsSilhouettesBeforeAnotherBackground) {
  const Scene scene = sceneFromJson(rowScene("0, 0, 0"));
  EXPECT_EQ(objectsInSight(scene, cameraView(scene.cameras.front(), {64, 64}), 0, Model::kPhong).size(), 3u);
}

/// Boxes going away into the fog, which hides some of them at any intensity.
std::string manyBoxes(const std::string& lights, const char* fog, const char* primitive = "box") {
  std::string boxes;
  for (int i = 1; i <= 40; ++i)
    boxes += fmt::format(R"({}{{"primitive": "{}", "translate": [{}, {}, {}], "material": "m"}})",
                         i > 1 ? ", " : "", primitive, i % 5 - 2, i / 5 % 5 - 2, -2.5 * i);
  return fmt::format(
      R"({{"camera": {{"eye": [0, 0, 0], "target": [0, 0, -1], "far": 500}}, "background": [0.5, 0.6, 0.7],
  "fog": {{{}, "color": [0.5, 0.6, 0.7]}}, "ambient": 0.1,
  "materials": {{"m": {{"diffuse": [0.5, 0.25, 0.75], "specular": 0.5, "shininess": 50}}}},
  "lights": [{}], "objects": [{}]}})",
      fog, lights, boxes);
}

/// How many objects are hidden in a picture that is within half a step of the one with all of them.
std::uint64_t expectHiddenUnseen(const std::string& json, Model model, float exposure) {
  const Scene scene = sceneFromJson(json);
  RenderSettings settings;
  settings.size = {64, 64};
  settings.camera = scene.cameras.front();
  settings.shade.model = model;
  settings.exposure = exposure;
  Stats stats;
  const Image culled = renderScene(testDevice(), scene, settings, stats);
  // Another background, so everything is drawn; its own pixels are told apart by it.
  Scene all = scene;
  all.background = glm::vec3(4);
  Stats unculled;
  const Image drawn = renderScene(testDevice(), all, settings, unculled);
  const float background = 4 * std::exp2(exposure);
  for (std::size_t i = 0; i < culled.pixels.size(); ++i) {
    if (drawn.pixels[i - i % 3] == background && drawn.pixels[i - i % 3 + 1] == background) continue;
    // Colours of the size of the fog's round to 2^-24 of it, twice.
    if (std::abs(culled.pixels[i] - drawn.pixels[i]) <= kHalfStep + 0x1p-23 * std::exp2(exposure)) continue;
    ADD_FAILURE() << "pixel " << i / 3 << ": " << culled.pixels[i] << ", with all objects "
                  << drawn.pixels[i];
    break;
  }
  const auto hidden = [](const Stats& of) {
    return std::find_if(of.counts.begin(), of.counts.end(),
                        [](const auto& count) { return count.first == "objects_hidden_by_fog"; })
        ->second;
  };
  EXPECT_EQ(hidden(unculled), 0u);
  return hidden(stats);
}

TEST(FogCull, HidesNothingThatABrightLightShows) {
  constexpr const char* kLights[] = {
      R"("type": "directional", "direction": [0.3, -0.4, -1])",
      R"("type": "point", "position": [1, 2, -50], "attenuation": [0, 0, 1])",
      R"("type": "point", "position": [-1, 1, -60], "range": 15)",
      R"("type": "spot", "position": [0, 5, -20], "direction": [0, -0.2, -1], "cutoff": 60, "exponent": 2)",
      R"("type": "point", "position": [0, 3, 0], "ambient": [1, 0.5, 0.25], "diffuse": 0, "specular": 0)"};
  for (const char* fog :
       {R"("mode": "exp", "density": 0.5)", R"("mode": "exp2", "density": [0.1, 0.12, 0.15])",
        R"("mode": "linear", "start": 5, "end": 60)"}) {
    for (const char* bright : kLights) {
      std::uint64_t least = 40, most = 0;
      for (const double intensity : {1e-3, 1.0, 1e3, 1e6, 1e9}) {
        SCOPED_TRACE(fmt::format("{} {} {}", bright, intensity, fog));
        // All lights are there, so that a fog's kernels are compiled once; of the others nothing is seen.
        std::string lights;
        for (const char* light : kLights)
          lights += fmt::format("{}{{{}, \"intensity\": {}}}", lights.empty() ? "" : ", ", light,
                                light == bright ? intensity : 1e-9);
        const std::uint64_t hidden = expectHiddenUnseen(manyBoxes(lights, fog), Model::kPhong, 0);
        least = std::min(least, hidden);
        most = std::max(most, hidden);
      }
      // It still hides: dim boxes all the same, and of bright ones those far enough away.
      EXPECT_GE(most, 15u) << bright << fog;
      EXPECT_GE(least, 5u) << bright << fog;
    }
  }
}

TEST(FogCull, HidesNothingThatAHighlightOrExposureShows) {
  // The sun stands behind the spheres, for Cook and Torrance's highlight at a glance, and Ward's.
  for (const Model model :
       {Model::kPhong, Model::kBlinnPhong, Model::kToon, Model::kCookTorrance, Model::kWard})
    for (const double intensity : {1e-3, 1.0, 1e6})
      for (const float exposure : {-10.0f, 0.0f, 10.0f}) {
        SCOPED_TRACE(fmt::format("{} {} {}", modelName(model), intensity, exposure));
        const std::string sun = fmt::format(
            R"({{"type": "directional", "direction": [0.5, -0.5, 1], "intensity": {}}})", intensity);
        const char* fog = R"("mode": "exp", "density": 0.5)";
        EXPECT_GT(expectHiddenUnseen(manyBoxes(sun, fog, "sphere"), model, exposure), 0u);
      }
}

TEST(FogCull, HidesNothingThatManyLightsShowTogether) {
  // Each is too dim to be seen; all lie on the box that the fog would hide, 25 m away.
  std::string json = rowScene("0.5, 0.6, 0.7");
  Scene scene = sceneFromJson(json);
  scene.objects[1].object_to_world[3] = {0, 0, -25, 1};
  const View view = cameraView(scene.cameras.front(), {64, 64});
  ASSERT_EQ(objectsInSight(scene, view, 0, Model::kPhong).size(), 2u);
  Light light;
  light.position = {0, 0, -24};
  light.range = 2;
  light.diffuse = glm::vec3(0.5f);
  scene.lights.assign(1000, light);
  EXPECT_EQ(objectsInSight(scene, view, 0, Model::kPhong).size(), 3u);
  for (Light& moved : scene.lights) moved.position.y = 9;  // out of reach
  EXPECT_EQ(objectsInSight(scene, view, 0, Model::kPhong).size(), 2u);
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
