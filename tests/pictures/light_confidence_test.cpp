// The promise of --light-error where lights cast shadows, against every light by exact rays and in double
// precision: as many pixels as stated are within their intervals, and on average the light is right.
#include "pictures/light_confidence.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "kernels/random_scene.hpp"
#include "long_run.hpp"
#include "render_json.hpp"
#include "shade/sampled_light.hpp"

namespace luciole::test {
namespace {

/// Bumps, a smooth ball of few triangles, leaves with holes and a box, all shiny, in fog.
Scene everySurface() {
  const TemporaryFolder folder;
  std::ofstream(folder / "ramp.pgm") << "P2 8 2 255 0 30 60 90 120 150 200 255 255 200 150 120 90 60 30 0";
  std::ofstream(folder / "holes.pgm") << "P2 4 4 255 0 255 255 0 255 255 0 255 255 0 255 255 0 255 255 255";
  std::ofstream(folder / "spots.pgm") << "P2 2 2 255 90 200 255 140";
  std::ofstream(folder / "scene.json")
      << R"({"camera": {"eye": [0, 1.6, 5], "target": [0, 0.5, 0], "fov_y": 40},
    "ambient": 0.05, "fog": {"mode": "exp2", "density": [0.05, 0.02, 0.01], "color": [0.2, 0.3, 0.4]},
    "materials": {
      "floor": {"bump_map": "ramp.pgm", "normal_scale": 4, "diffuse": 0.7, "specular": 0.3, "shininess": 20},
      "ball": {"diffuse": [0.6, 0.5, 0.1], "specular": 0.4, "shininess": 60, "emission": [0, 0.1, 0]},
      "leaf": {"diffuse": [0.2, 0.6, 0.2], "diffuse_map": "spots.pgm", "alpha_map": "holes.pgm", "alpha_cutoff": 0.5,
               "specular": 0.2, "shininess": 5, "double_sided": true}},
    "objects": [{"primitive": "plane", "scale": 8, "uv_scale": 40, "material": "floor"},
                {"primitive": "sphere", "segments": 16, "translate": [0.7, 0.7, 0], "scale": 0.7, "material": "ball"},
                {"primitive": "box", "translate": [-1.2, 0.5, -0.5], "rotate": [0, 30, 0], "material": "ball"},
                {"primitive": "plane", "scale": 2, "uv_scale": 6, "translate": [-0.3, 1.1, 1], "rotate": [20, 0, 10],
                 "material": "leaf"}]})";
  return loadScene(folder / "scene.json");
}

/// Lights that cast shadows around what is seen, `least` of the brightest's intensity or more. All together
/// give about 1.
void lightAround(std::size_t count, double least, Random& random, Scene& scene) {
  scene.lights.clear();
  for (std::size_t i = 0; i < count; ++i) {
    Light light{.attenuation = {0, 0, 1}};
    light.position = {random.between(-4, 4), random.between(-0.2, 3), random.between(-4, 4)};
    const double intensity = 8 / double(count) * std::pow(least, random.between(0, 1));
    light.diffuse = intensity * random.color();
    light.specular = random.chance(0.5) ? light.diffuse : glm::vec3(intensity * random.color());
    light.shadow = true;
    scene.lights.push_back(light);
  }
}

/// Directional lights from everywhere that cast shadows, `least` of the brightest's intensity or more. All
/// together give about 1. Half of them stand for their part of the sky.
void skyAround(std::size_t count, double least, Random& random, Scene& scene) {
  for (std::size_t i = 0; i < count; ++i) {
    Light light{.kind = LightKind::kDirectional, .direction = random.direction()};
    const double intensity = 6 / double(count) * std::pow(least, random.between(0, 1));
    light.diffuse = intensity * random.color();
    light.specular = random.chance(0.5) ? light.diffuse : glm::vec3(intensity * random.color());
    light.shadow = true;
    if (random.chance(0.5)) light.cell = float(12.6 / double(count));
    scene.lights.push_back(light);
  }
}

/// The same of parts of faces, around what is seen, of which one in four shines on a point.
void facesAround(std::size_t count, double least, Random& random, Scene& scene) {
  Scene around;
  lightAround(count, least, random, around);
  for (Light& light : around.lights) {
    light.kind = LightKind::kSpot;
    light.diffuse *= 6.0f;
    light.specular *= 6.0f;
    light.direction = random.direction();
    light.cutoff = glm::radians(90.0);
    light.exponent = 1;
    if (random.chance(0.5)) light.cell = float(random.between(0, 0.1));
    scene.lights.push_back(light);
  }
}

/// Every channel of every pixel is a number.
void expectFinite(const Image& image) {
  EXPECT_TRUE(
      std::all_of(image.pixels.begin(), image.pixels.end(), [](float v) { return std::isfinite(v); }));
}

using LightScene = void (*)(std::size_t count, double least, Random& random, Scene& scene);

/// rounding: what is left to floats beyond the interval, as a share of the larger of 1 and the light.
void expectSummed(std::size_t lights, bool highlights, Model model, double rounding,
                  Scene scene = everySurface(), LightScene light_scene = lightAround) {
  SCOPED_TRACE(fmt::format("{} lights, model {}", lights, int(model)));
  Random random{unsigned(lights)};
  scene.lights.clear();
  light_scene(lights, 0.01, random, scene);
  if (!highlights)
    for (Light& light : scene.lights) light.specular = glm::vec3(0.0f);
  const glm::ivec2 size = longRun() ? glm::ivec2(64, 36) : glm::ivec2(48, 27);
  const ShadowedTruth truth = shadowedTruth(testDevice(), scene, size, std::size_t(-1), model);
  Stats stats;
  const Image image = sampledPicture(testDevice(), truth, {.light_error = 1e-6f}, stats);
  expectFinite(image);
  EXPECT_EQ(countOf(stats, "lights_sampled"), lights);
  EXPECT_EQ(countOf(stats, "pixels_beyond_light_error"), 0u);
  // Where a hole's rim decides, half of a light is proven to be unsure.
  std::size_t unsure = 0;
  for (std::size_t i = 0; i < truth.pixels.size(); ++i)
    for (int c = 0; c < 3; ++c) {
      const glm::ivec2 pixel = truth.pixels[i];
      const float* value = &image.pixels[9 * (std::size_t(pixel.y) * image.width + pixel.x) + c];
      const double bound = value[3], right = truth.radiance[i][c];
      ASSERT_LE(std::abs(value[0] - right), bound + rounding * std::max(right, 1.0))
          << right << " at " << pixel.x << ", " << pixel.y;
      ASSERT_EQ(value[6], 1) << "all of it is proven";
      unsure += bound > 1e-4 * std::max(right, 1.0);
    }
  EXPECT_LT(unsure, 3 * truth.pixels.size() / 5);
}

// Where no stratum has more than two lights all are summed, and nothing is left to chance.
TEST(LightConfidence, OfFewLightsTheIntervalIsWhatFloatsRound) {
  for (const std::size_t lights : {1, 2, 3, 50}) expectSummed(lights, false, Model::kPhong, 0);
}

// A lobe multiplies what its cosine rounds by its exponent, 60 at most, and each light gives a few units.
TEST(LightConfidence, OfFewLightsHighlightsAreWhatFloatsRound) {
  for (const Model model : {Model::kPhong, Model::kBlinnPhong})
    for (const std::size_t lights : {1, 3, 50}) expectSummed(lights, true, model, 0);
}

// What a direction, an axis and a cosine round is up to 4 · 2⁻²⁴ of a light, however small the cosine is.
TEST(LightConfidence, OfFewDirectionsAndFacesTheIntervalIsWhatFloatsRound) {
  for (const LightScene light_scene : {skyAround, facesAround})
    for (const Model model : {Model::kPhong, Model::kBlinnPhong})
      for (const std::size_t lights : {1, 3, 50})
        for (const bool highlights : {false, true})
          expectSummed(lights, highlights, model, 0x1p-22, everySurface(), light_scene);
}

// There a light's place in view space isn't a float: it takes two.
TEST(LightConfidence, OfFewLightsFarFromTheEyeTheIntervalIsWhatFloatsRound) {
  Scene scene = everySurface();
  scene.fog = {};
  Camera& camera = scene.cameras.front();
  const double distance = 30'000;
  camera.camera_to_world[3] =
      glm::dvec4(glm::dvec3(0, 0.5, 0) + distance * glm::dvec3(camera.camera_to_world[2]), 1);
  camera.fov_y = 2 * std::atan(1.9 / distance);
  camera.far = 2 * distance;
  expectSummed(50, false, Model::kPhong, 0, scene);
}

/// What several seeds gave together. Groups of pixels are counted once for each set of lights.
struct Calibration {
  HeldShare held;
  double bias = 0, rmse = 0, width = 0;  ///< as in ConfidenceCheck
  double groups = 0;                     ///< of pixels, in all pictures
};

Calibration calibrate(const ShadowedTruth& truth, ShadeSettings shade, unsigned seeds) {
  Calibration sum;
  for (shade.seed = 0; shade.seed < seeds; ++shade.seed) {
    const ConfidenceCheck check = checkConfidence(testDevice(), truth, shade);
    EXPECT_EQ(countOf(check.stats, "lights_sampled"), truth.scene.lights.size());
    EXPECT_EQ(countOf(check.stats, "pixels_beyond_light_error"), 0u);
    sum.held.values += check.all.values;
    sum.held.held += check.all.held;
    sum.bias += check.bias / seeds;
    sum.rmse += check.rmse * check.rmse / seeds;
    sum.width += check.width / seeds;
    sum.groups += double(countOf(check.stats, "sampled_groups"));
  }
  sum.rmse = std::sqrt(sum.rmse);
  return sum;
}

/// Pixels of a group share picks, so they may all hold or fail together, and be wrong in the same direction.
/// Groups are independent. So of n groups the share that holds varies by √(C(1 − C)/n) at most, and the mean
/// of the errors by their deviation over √n.
void expectCalibrated(const ShadowedTruth& truth, const ShadeSettings& shade, unsigned seeds,
                      unsigned sets = 1) {
  SCOPED_TRACE(fmt::format("E = {}, C = {}", shade.light_error, shade.confidence));
  Calibration all = calibrate(truth, shade, seeds);
  all.groups /= sets;
  const double c = shade.confidence;
  EXPECT_GE(all.held.share(), c - 3 * std::sqrt(c * (1 - c) / all.groups));
  EXPECT_LE(std::abs(all.bias), 4 * all.rmse / std::sqrt(all.groups));
  EXPECT_LE(all.width, 1);
  EXPECT_GT(all.rmse, 0.02) << "the picture is as good as exact: nothing was tested";
  EXPECT_LE(all.width, 4 * all.rmse * deviationsOf(c)) << "intervals that say nothing";
}

void expectCalibratedAtAll(const ShadowedTruth& truth, unsigned seeds, unsigned sets = 1) {
  for (const auto& [error, confidence] :
       {std::pair{1.0f / 16, 0.9}, std::pair{1.0f / 16, 0.99}, std::pair{1.0f / 64, 0.9}})
    expectCalibrated(truth, {.light_error = error, .confidence = confidence}, seeds, sets);
}

TEST(LightConfidence, HoldsAsOftenAsStatedOfEverySurface) {
  for (const Model model : {Model::kPhong, Model::kBlinnPhong}) {
    Scene scene = everySurface();
    Random random(1);
    lightAround(2000, 0.01, random, scene);
    expectCalibratedAtAll(shadowedTruth(testDevice(), scene, {64, 36}, std::size_t(-1), model),
                          longRun() ? 16 : 3);
  }
}

TEST(LightConfidence, HoldsAsOftenAsStatedOfSkiesAndFaces) {
  const struct { std::size_t sky, faces, points; } cases[] = {{4096, 0, 0}, {0, 4096, 0}, {4096, 4096, 1000}};
  for (const Model model : {Model::kPhong, Model::kBlinnPhong})
    for (const auto& [sky, faces, points] : cases) {
      SCOPED_TRACE(fmt::format("{} directions, {} faces, {} points", sky, faces, points));
      Scene scene = everySurface();
      Random random(9);
      lightAround(points, 0.01, random, scene);
      skyAround(sky, 0.01, random, scene);
      facesAround(faces, 0.01, random, scene);
      const unsigned sets = sky > 0 && faces > 0 ? 2 : 1;
      expectCalibratedAtAll(shadowedTruth(testDevice(), scene, {64, 36}, std::size_t(-1), model),
                            longRun() ? 16 : 2, sets);
    }
}

TEST(LightConfidence, HoldsAsOftenAsStatedOfShippedScenes) {
  for (const auto& [name, placement] :
       {std::pair{"cornell", FieldShape::kSurface}, std::pair{"colonnade", FieldShape::kClusters}}) {
    SCOPED_TRACE(name);
    Scene scene = loadScene(fmt::format("{}/scenes/{}.json", LUCIOLE_SOURCE_DIR, name));
    lightWithoutRange(scene, placement, 2000, false);
    for (Light& light : scene.lights) light.shadow = true;
    expectCalibratedAtAll(shadowedTruth(testDevice(), scene, {64, 36}, std::size_t(-1)), longRun() ? 16 : 3);
  }
}

// Strata are kept where their samples agree, and halved where they don't. What chance made agree would leave
// light out.
TEST(LightConfidence, LightIsRightOnAverageHoweverFine) {
  Scene scene = loadScene(LUCIOLE_SOURCE_DIR "/scenes/colonnade.json");
  lightWithoutRange(scene, FieldShape::kBox, 20'000, false);
  for (Light& light : scene.lights) light.shadow = true;
  const ShadowedTruth truth = shadowedTruth(testDevice(), scene, {64, 36}, std::size_t(-1));
  const Calibration all =
      calibrate(truth, {.light_error = 1.0f / 256, .confidence = 0.9}, longRun() ? 16 : 2);
  EXPECT_LE(std::abs(all.bias), 4 * all.rmse / std::sqrt(all.groups));
}

/// A floor, a ball and a wall that keeps the light of half of all places from the rest.
Scene plainScene() {
  return sceneFromJson(R"({"camera": {"eye": [0, 2, 5], "target": [0, 0.5, 0], "fov_y": 45},
    "materials": {"m": {"diffuse": [0.7, 0.5, 0.3]}},
    "objects": [{"primitive": "plane", "scale": 8, "material": "m"},
                {"primitive": "sphere", "translate": [0.8, 0.8, 0], "scale": 0.8, "material": "m"},
                {"primitive": "box", "scale": [0.1, 1.5, 6], "translate": [-0.7, 0.7, 0], "material": "m"}]})");
}

/// Every number is finite, and pixels are within their intervals.
void expectHeld(const Scene& scene, const ShadeSettings& shade = {.light_error = 1.0f / 16}) {
  const ShadowedTruth truth = shadowedTruth(testDevice(), scene, {48, 27}, std::size_t(-1));
  Stats stats;
  expectFinite(sampledPicture(testDevice(), truth, shade, stats));
  const ConfidenceCheck check = checkConfidence(testDevice(), truth, shade);
  EXPECT_EQ(countOf(check.stats, "lights_sampled"), scene.lights.size());
  // See expectCalibrated(). One picture has few groups.
  const double c = shade.confidence, groups = double(countOf(check.stats, "sampled_groups"));
  EXPECT_GE(check.all.share(), c - 4 * std::sqrt(c * (1 - c) / groups));
}

TEST(HardLightConfidence, OfLightsInsideAndOnSurfaces) {
  Scene scene = plainScene();
  Random random(1);
  lightAround(1500, 1, random, scene);
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    glm::dvec3& place = scene.lights[i].position;
    if (i % 3 == 0) place.y = -0.01 * random.between(0, 1);                      // under the floor
    if (i % 3 == 1) place.y = i % 2 == 0 ? 0 : 1e-6;                             // in it
    if (i % 3 == 2) place = glm::dvec3(0.8, 0.8, 0) + 0.8 * random.direction();  // on the ball
    if (i % 7 == 0) place = glm::dvec3(0.8, 0.8, 0) + 0.5 * random.direction();  // in it
  }
  expectHeld(scene);
}

TEST(HardLightConfidence, OfLightsAtOnePoint) {
  Scene scene = plainScene();
  Random random(2);
  lightAround(1500, 1e-3, random, scene);
  for (Light& light : scene.lights) light.position = {-0.3, 1.9, 0.6};
  expectHeld(scene);
}

TEST(HardLightConfidence, OfLightsAHundredMillionMetresApart) {
  Scene scene = plainScene();
  Random random(3);
  lightAround(1500, 1e-3, random, scene);
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    if (i % 3 == 0) continue;
    scene.lights[i].position = 1e8 * random.direction();
    scene.lights[i].diffuse *= i % 3 == 1 ? 1e16f : 1;
  }
  expectHeld(scene);
}

TEST(HardLightConfidence, OfIntensitiesFortyOrdersApart) {
  Scene scene = plainScene();
  Random random(4);
  lightAround(1500, 1, random, scene);
  for (Light& light : scene.lights) light.diffuse = glm::vec3(std::pow(10.0, random.between(-20, 20)));
  expectHeld(scene);
}

// Which of them that is, importance says; luck would find it in one pixel of ten.
TEST(HardLightConfidence, OfTheOnlyLightThatMatters) {
  for (const double intensity : {1.0, 100.0, 1e4, 1e20}) {
    SCOPED_TRACE(intensity);
    Scene scene = plainScene();
    Random random(5);
    lightAround(3000, 1, random, scene);
    for (Light& light : scene.lights) light.diffuse *= 1e-20f;
    scene.lights[1234].diffuse = glm::vec3(intensity);
    scene.lights[1234].position = {0.3, 1.7, 1.5};
    expectHeld(scene);
  }
}

// Importance sends all rays to the bright one.
TEST(HardLightConfidence, OfDimLightsAroundABrightOneThatNobodySees) {
  for (const double intensity : {1.0, 10.0, 100.0, 1e4, 1e8}) {
    SCOPED_TRACE(intensity);
    Scene scene = plainScene();
    Random random(6);
    lightAround(1500, 1, random, scene);
    scene.lights[777].diffuse = glm::vec3(intensity);
    scene.lights[777].position = {0.8, 0.8, 0};  // in the ball
    expectHeld(scene);
  }
}

TEST(HardLightConfidence, OfNothingThatIsSeenByAnyLight) {
  Scene scene = plainScene();
  Random random(7);
  lightAround(1500, 1, random, scene);
  scene.ambient = glm::vec3(0.0f);
  for (Light& light : scene.lights) light.position = glm::dvec3(0.8, 0.8, 0) + 0.5 * random.direction();
  Stats stats;
  const ShadowedTruth truth = shadowedTruth(testDevice(), scene, {48, 27}, std::size_t(-1));
  const Image image = sampledPicture(testDevice(), truth, {.light_error = 1.0f / 16}, stats);
  float largest_interval = 0;
  for (std::size_t i = 0; i < image.pixels.size(); i += 9)
    for (std::size_t c = 0; c < 3; ++c) {
      ASSERT_LT(image.pixels[i + c], 1e-30f);
      largest_interval = std::max(largest_interval, image.pixels[i + 3 + c]);
    }
  EXPECT_GT(largest_interval, 1e-4f) << "samples that all missed prove no darkness";
  EXPECT_LE(largest_interval, 1.0f / 16);
  EXPECT_EQ(countOf(stats, "pixels_beyond_light_error"), 0u);
}

TEST(HardLightConfidence, OfOnePixelAndOfNone) {
  Scene scene = plainScene();
  Random random(8);
  lightAround(1500, 1, random, scene);
  RenderSettings settings = settingsFor(scene, {1, 1});
  settings.shade.shadows = ShadowMethod::kExact;
  settings.shade.light_error = 1.0f / 16;
  settings.shade.always_clusters = true;
  settings.aovs = {Aov::kLightError, Aov::kLightProof};
  const Image one = picture(scene, settings);
  expectFinite(one);
  EXPECT_GT(one.pixels[0], 0);
  EXPECT_GT(one.pixels[3], 0);
  scene.objects.clear();
  scene.background = {0.1f, 0.2f, 0.3f};
  settings.size = {20, 20};
  const Image none = picture(scene, settings);
  for (std::size_t i = 0; i < none.pixels.size(); i += 9)
    for (std::size_t c = 0; c < 3; ++c) {
      ASSERT_EQ(none.pixels[i + c], scene.background[int(c)]);
      ASSERT_LE(none.pixels[i + 3 + c], 0x1p-21f) << "no more than it rounds";
      ASSERT_EQ(none.pixels[i + 6 + c], 1);
    }
}

}  // namespace
}  // namespace luciole::test
