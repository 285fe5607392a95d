// A renderer keeps what its next picture needs, and no picture shows it.
#include "luciole/render.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <optional>
#include <stdexcept>
#include <vector>

#include "luciole/error.hpp"
#include "luciole/pose.hpp"
#include "render/measure_exposure.hpp"
#include "render/renderer.hpp"
#include "render_json.hpp"

namespace luciole::test {
namespace {

constexpr const char* kRenderedScene =
    R"({"camera": {"eye": [3, 2, 5], "target": [0, 0.5, 0], "fov_y": 60}, "background": [0, 0, 0.25], "ambient": 0.1,
  "materials": {"m": {"diffuse": [0.6, 0.5, 0.4], "specular": 0.5, "shininess": 32}},
  "objects": [{"primitive": "plane", "scale": 20, "segments": 9, "material": "m"},
              {"primitive": "sphere", "translate": [0, 1, 0], "material": "m",
               "keys": [{"frame": 1, "translate": [0, 1, 0]}, {"frame": 5, "translate": [1, 1, 1]}]}],
  "lights": [{"type": "directional", "direction": [-1, -2, -1], "intensity": 0.5, "shadow": true},
             {"type": "point", "position": [1, 2, 2], "range": 4, "shadow": true, "color": [1, 0.5, 0.2]},
             {"type": "spot", "position": [-2, 4, 2], "target": [0, 0, 0], "cutoff": 40, "exponent": 4}]})";

Renderer rendererOf(const Scene& scene) {
  return makeRenderer(std::vector<OpenedDevice*>{&testDevice()}, scene);
}

TEST(Renderer, PicturesHaveTheBitsOfASingleOneWhateverChangedBetweenThem) {
  const Scene scene = sceneFromJson(kRenderedScene);
  Renderer renderer = rendererOf(scene);
  RenderSettings settings = settingsFor(scene, {90, 70});
  const std::vector<std::pair<const char*, std::function<void(Scene&)>>> changes{
      {"nothing", [](Scene&) {}},
      {"the camera", [&](Scene&) { settings.camera.camera_to_world[3] += glm::dvec4(0.5, 0.25, -1, 0); }},
      {"the size",
       [&](Scene&) {
         settings.size = {64, 100};
       }},
      {"a layer",
       [&](Scene&) {
         settings.aovs = {Aov::kNormal, Aov::kShadow};
       }},
      {"no layer", [&](Scene&) { settings.aovs = {}; }},
      {"the samples", [&](Scene&) { settings.samples = 4; }},
      {"alpha", [&](Scene&) { settings.alpha = true; }},
      {"no alpha, one sample", [&](Scene&) { settings.alpha = false, settings.samples = 1; }},
      {"exact shadows", [&](Scene&) { settings.shade.shadows = ShadowMethod::kExact; }},
      {"the eye again", [&](Scene&) { settings.camera.camera_to_world[3].x -= 2; }},
      {"a light", [](Scene& one) { one.lights[1].position.x -= 1, one.lights[1].diffuse.y = 2; }},
      {"soft shadows by maps", [&](Scene&) { settings.shade.shadows = ShadowMethod::kPcf; }},
      {"a light's shadow", [](Scene& one) { one.lights[2].shadow = true; }},
      {"a light that is gone", [](Scene& one) { one.lights.erase(one.lights.begin()); }},
      {"a material", [](Scene& one) { one.materials[0].specular = glm::vec3(0); }},
      {"fog", [](Scene& one) { one.fog = {.mode = FogMode::kExp, .density = glm::vec3(0.1f)}; }},
      {"the pose", [](Scene& one) { poseScene(one, 3); }},
      {"no light", [](Scene& one) { one.lights.clear(); }},
  };
  Scene alone = scene;
  for (const auto& [what, change] : changes) {
    change(alone);
    renderer.scene() = alone;
    const Image one = renderer.render(settings).image;
    const Image other = picture(alone, settings);
    EXPECT_EQ(one.channels, other.channels) << what;
    EXPECT_TRUE(one.pixels == other.pixels) << what;
  }
}

TEST(Renderer, GoesOnAfterATakerThatHasEnough) {
  const Scene scene = sceneFromJson(kRenderedScene);
  Renderer renderer = rendererOf(scene);
  RenderSettings settings = settingsFor(scene, {90, 200});
  settings.band_height = 64;
  Stats stats;
  int bands = 0;
  EXPECT_THROW(renderer.render(
                   settings,
                   [&](const Image&) {
                     if (++bands == 2) throw std::logic_error("enough");
                   },
                   stats),
               std::logic_error);
  EXPECT_EQ(bands, 2);
  EXPECT_TRUE(renderer.render(settings).image.pixels == picture(scene, settings).pixels);
}

TEST(Renderer, RefusesAnInvalidSceneAndSettings) {
  Scene scene = sceneFromJson(kRenderedScene);
  scene.lights[0].diffuse.x = -1;
  Renderer renderer = rendererOf(scene);
  RenderSettings settings = settingsFor(scene, {8, 8});
  EXPECT_THROW(renderer.render(settings), InputError);
  EXPECT_THROW(renderer.render(settings), InputError) << "it isn't taken as checked";
  renderer.scene().lights[0].diffuse.x = 1;
  settings.samples = 0;
  EXPECT_THROW(renderer.render(settings), InputError);
}

TEST(Renderer, MeasuresTheExposureOfItsPicture) {
  const Scene scene = sceneFromJson(kRenderedScene);
  const RenderSettings settings = settingsFor(scene, {90, 70});
  Stats stats;
  EXPECT_EQ(rendererOf(scene).measureExposure(settings, stats),
            measureExposure(testDevice(), scene, settings, stats));
  EXPECT_GT(stageTime(stats, Stage::kMeasureExposure), 0);
}

}  // namespace
}  // namespace luciole::test
