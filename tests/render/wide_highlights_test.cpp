// Highlights of lights that stand for parts of a larger source.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kernels/probe.hpp"
#include "reference/reference.hpp"
#include "render_json.hpp"
#include "scene/models.hpp"
#include "shade/features.hpp"

namespace luciole::test {
namespace {

constexpr const char* kShinyScene =
    R"({"camera": {"eye": [3, 2, 5], "target": [0, 0.5, 0]}, "ambient": [0.1, 0.1, 0.1],
  "materials": {"m": {"diffuse": [0.6, 0.5, 0.4], "specular": 0.5, "shininess": 32}},
  "objects": [{"primitive": "plane", "scale": 10, "material": "m"}, {"primitive": "sphere", "translate": [0, 1, 0], "material": "m"}],
  "lights": [{"type": "directional", "direction": [-1, -2, -1], "color": [0.5, 0.5, 0.5]},
             {"type": "point", "position": [1, 2, 2], "range": 4, "ambient": [0.1, 0, 0], "diffuse": [1, 0.5, 0.2]},
             {"type": "spot", "position": [-2, 4, 2], "direction": [1, -1, -1], "cutoff": 90, "exponent": 1, "attenuation": [0, 0, 0.1]}]})";

Scene shinyScene(float cell) {
  Scene scene = sceneFromJson(kShinyScene);
  for (Light& light : scene.lights) light.cell = cell;
  return scene;
}

RenderSettings settingsOf(const Scene& scene, Model model, glm::ivec2 size) {
  RenderSettings settings;
  settings.size = size;
  settings.camera = scene.cameras.front();
  settings.shade.model = model;
  return settings;
}

// About 40 roundings of 2^-24 between a light and the sum, on the largest of three lights' terms below 2; the
// lobe's power multiplies its argument's error (4·2^-24) by the exponent 32 and by log2 e. The exponent
// itself has some 14 roundings, which change a lobe by at most (1 + 1/e) times as much.
constexpr double kTolerance = 2 * (40 + 4 * 32 * 1.4427 + 14 * 1.37) * 0x1p-24;

/// What a model makes larger: toon's ramps have a slope of 32, and the normalized lobes a peak of 34/8.
double slopeOf(Model model) {
  return model == Model::kToon ? 33 : model == Model::kCookTorrance || model == Model::kWard ? 5 : 1;
}

class WideHighlights : public testing::TestWithParam<int> {};

TEST_P(WideHighlights, AgreeWithTheDoublePrecisionReference) {
  for (const Model model : kAllModels)
    for (const float cell : {1e-8f, 1e-3f, 0.1f, 0.5f, 6.0f}) {
      SCOPED_TRACE(fmt::format("model {}, a cell of {}", int(model), cell));
      const Scene scene = shinyScene(cell);
      const RenderSettings settings = settingsOf(scene, model, {80, 45});
      Stats stats;
      const GBuffer gbuffer = rasterizeScene(nullptr, scene, settings, stats);
      const Image ours = renderScene(deviceWithLanes(GetParam()), scene, settings, stats);
      const Image truth = referenceShade(scene, gbuffer, {.model = model});
      double worst = 0;
      for (std::size_t i = 0; i < ours.pixels.size(); ++i)
        worst = std::max(worst, std::abs(double(ours.pixels[i]) - truth.pixels[i]));
      EXPECT_LE(worst, slopeOf(model) * kTolerance);
    }
}

INSTANTIATE_TEST_SUITE_P(Lanes, WideHighlights, testing::ValuesIn(widths()),
                         testing::PrintToStringParamName());

// The smaller exponent is the surface's own, and its light one times what it was.
TEST(WideHighlight, OfACellThatIsNarrowerThanTheLobeIsThatOfAPoint) {
  for (const Model model : kAllModels) {
    const Scene points = shinyScene(0), cells = shinyScene(1e-9f);
    const RenderSettings settings = settingsOf(points, model, {80, 45});
    EXPECT_TRUE(picture(points, settings).pixels == picture(cells, settings).pixels) << int(model);
    const auto isWide = [&](const Scene& scene) {
      return neededFeatures(scene, settings.camera, materialTraits(scene), settings.shade)
          .has(Feature::kWideHighlights);
    };
    EXPECT_FALSE(isWide(points));
    EXPECT_TRUE(isWide(cells));
  }
}

TEST(WideHighlight, OfDullSurfacesIsNone) {
  Scene scene = shinyScene(0.1f);
  for (Material& material : scene.materials) material.specular = glm::vec3(0.0f);
  const ShadeSettings settings;
  EXPECT_FALSE(neededFeatures(scene, scene.cameras.front(), materialTraits(scene), settings)
                   .has(Feature::kWideHighlights));
}

/// A ball that is nearly a mirror, under so many lights of a sky of radiance 1, as the eye sees it in a
/// square picture where it doesn't slant by more than 45 degrees.
Scene mirrorUnderSky(int lights) {
  Scene scene = sceneFromJson(R"({"camera": {"eye": [0, 0, 20], "target": [0, 0, 0], "fov_y": 2.8},
    "materials": {"m": {"diffuse": 0, "specular": 1, "shininess": 1000}},
    "objects": [{"primitive": "sphere", "segments": 256, "material": "m"}], "lights": []})");
  for (int i = 0; i < lights; ++i) {
    const double up = 1 - (2 * i + 1.0) / lights, across = std::sqrt(1 - up * up), turn = 2.39996322973 * i;
    Light light{.kind = LightKind::kDirectional,
                .direction = {across * std::cos(turn), up, across * std::sin(turn)}};
    // A light of 1 is an irradiance of π.
    light.cell = float(4 * std::numbers::pi / lights);
    light.diffuse = light.specular = glm::vec3(4.0f / float(lights));
    scene.lights.push_back(light);
  }
  return scene;
}

/// The least and the largest value of a picture.
std::pair<float, float> rangeOf(const Image& image) {
  const auto [least, largest] = std::minmax_element(image.pixels.begin(), image.pixels.end());
  return {*least, *largest};
}

// All over the ball Phong's lobe gathers 1/π · 2π/(n + 1) of the sky, and normalized models nearly all light.
// Cook-Torrance's lobe has the sharpest peak: a grid of them ripples by 2·x·K₁(x) = 1.2 % along each axis, x
// = 2π (the Fourier transform of GGX), and in the spiral some lights are nearer to each other. Masking takes
// some of its light.
TEST(WideHighlight, OfASkyOfFewLightsHasNoDotsAndTheLightOfMany) {
  const struct {
    Model model;
    double light;
  } cases[] = {{Model::kPhong, 2.0 / 1001},
               {Model::kOrenNayar, 2.0 / 1001},
               {Model::kCookTorrance, 1},
               {Model::kWard, 1}};
  for (const int lights : {1024, 4096})
    for (const auto& [model, light] : cases) {
      SCOPED_TRACE(fmt::format("{} lights, model {}", lights, int(model)));
      const Scene scene = mirrorUnderSky(lights);
      const auto [least, largest] = rangeOf(picture(scene, settingsOf(scene, model, {32, 32})));
      EXPECT_GE(least, 0.96 * light);
      EXPECT_LE(largest, 1.04 * light);
    }
}

// The half vector's lobe is narrower across than along, so the light falls with the cosine of incidence.
TEST(WideHighlight, OfBlinnHoldsWhatManyLightsGive) {
  const auto pictureOf = [](int lights) {
    const Scene scene = mirrorUnderSky(lights);
    return picture(scene, settingsOf(scene, Model::kBlinnPhong, {24, 24}));
  };
  // There cells are a tenth as large as the lobe.
  const Image few = pictureOf(1024), many = pictureOf(60'000);
  for (std::size_t i = 0; i < few.pixels.size(); ++i)
    ASSERT_NEAR(few.pixels[i], many.pixels[i], 0.03 * many.pixels[i]) << "pixel " << i / 3;
}

}  // namespace
}  // namespace luciole::test
