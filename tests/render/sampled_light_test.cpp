// Lights that cast shadows with --light-error: the same bits however a picture is made, and one by one where
// that is asked for or faster.
#include "shade/sampled_light.hpp"
#include "shade/features.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

#include "kernels/probe.hpp"
#include "raster/bins.hpp"
#include "render_json.hpp"

namespace luciole::test {
namespace {

/// A grid of lights over a ball, a box and a floor. kind: further keys of a light.
std::string gridOfLights(int rows, double intensity, const std::string& kind) {
  std::string lights;
  for (int i = 0; i < rows * rows; ++i)
    lights += fmt::format(
        R"({}{{"type": "point", "position": [{}, {}, {}], "color": [1, 0.5, 0.2], "intensity": {}, "attenuation": [0, 0, 1]{}}})",
        lights.empty() ? "" : ",", 6.0 * (i % rows) / rows - 3 + 0.01 * (i % 7), 0.4 + 0.25 * (i % 9),
        6.0 * (i / rows) / rows - 3 + 0.01 * (i % 5), intensity / (rows * rows), kind);
  return lights;
}
constexpr const char* kCasts = R"(, "shadow": true)";

/// Directional lights from all around, evenly. kind: further keys of a light.
std::string skyOfLights(int count, double intensity, const std::string& kind) {
  std::string lights;
  for (int i = 0; i < count; ++i) {
    const double up = 1 - (2 * i + 1.0) / count, across = std::sqrt(1 - up * up), turn = 2.399963 * i;
    lights += fmt::format(
        R"({}{{"type": "directional", "direction": [{}, {}, {}], "color": [0.5, 0.8, 1], "intensity": {}{}}})",
        lights.empty() ? "" : ",", across * std::cos(turn), up, across * std::sin(turn), intensity / count,
        kind);
  }
  return lights;
}

Scene sceneWith(const std::string& lights) {
  return sceneFromJson(
      R"({"camera": {"eye": [3, 2, 5], "target": [0, 0.5, 0], "fov_y": 50}, "background": [0, 0, 0.25], "ambient": 0.05,
  "materials": {"m": {"diffuse": [0.6, 0.5, 0.4], "specular": 0.3, "shininess": 32}},
  "objects": [{"primitive": "plane", "scale": 5, "material": "m"},
              {"primitive": "sphere", "segments": 16, "translate": [0, 1, 0], "material": "m"},
              {"primitive": "box", "translate": [1.5, 0.5, 1.5], "material": "m"}],
  "lights": [)" +
      lights + "]}");
}

const Scene& sampledScene() {
  static const Scene scene = sceneWith(gridOfLights(30, 8, kCasts));
  return scene;
}

RenderSettings sampledSettings(const Scene& scene, glm::ivec2 size) {
  RenderSettings settings = settingsFor(scene, size);
  settings.shade.shadows = ShadowMethod::kExact;
  settings.shade.light_error = 1.0f / 16;
  settings.shade.always_clusters = true;
  settings.aovs = {Aov::kLightError, Aov::kLightProof};
  return settings;
}

constexpr const char* kFace =
    R"(, "type": "spot", "direction": [0.6, -0.8, 0], "cutoff": 90, "exponent": 1, "shadow": true)";
/// A grid of lights with keys of a spot.
std::string gridOfFaces(int rows, double intensity) {
  std::string lights = gridOfLights(rows, intensity, kFace);
  const std::string point = R"("type": "point", )";
  for (std::size_t at; (at = lights.find(point)) != lights.npos;) lights.erase(at, point.size());
  return lights;
}

/// A sky, faces and points, with cells.
const Scene& skyScene() {
  static const Scene scene = [] {
    Scene lit = sceneWith(skyOfLights(1000, 1.5, kCasts) + "," + gridOfFaces(25, 4) + "," +
                          gridOfLights(20, 3, kCasts));
    for (Light& light : lit.lights) light.cell = 0.004f;
    return lit;
  }();
  return scene;
}

/// Channels of `picture` and of its layers.
constexpr std::size_t kChannels = 9, kError = 3, kProof = 6;

TEST(SampledLight, IsTheSameBitsAtEveryWidthAndEveryTime) {
  const RenderSettings settings = sampledSettings(sampledScene(), {70, 50});
  Stats stats;
  const Image first = renderScene(testDevice(), sampledScene(), settings, stats);
  EXPECT_EQ(countOf(stats, "lights_sampled"), 900u);
  EXPECT_GT(countOf(stats, "sampled_rays"), 10u * countOf(stats, "pixels_lit"));
  EXPECT_EQ(picture(sampledScene(), settings).pixels, first.pixels) << "twice";
  for (const int lanes : widths()) {
    Stats other;
    const Image image = renderScene(deviceWithLanes(lanes), sampledScene(), settings, other);
    EXPECT_TRUE(image.pixels == first.pixels) << lanes << " lanes";
    for (const char* count : {"sampled_rays", "sampled_groups", "sampled_strata", "sampled_rounds"})
      EXPECT_EQ(countOf(other, count), countOf(stats, count)) << lanes << " lanes";
  }
}

TEST(SampledLight, OfSkiesAndFacesIsTheSameBitsAtEveryWidth) {
  const RenderSettings settings = sampledSettings(skyScene(), {70, 50});
  Stats stats;
  const Image first = renderScene(testDevice(), skyScene(), settings, stats);
  EXPECT_EQ(countOf(stats, "lights_sampled"), skyScene().lights.size());
  for (const int lanes : widths()) {
    Stats other;
    EXPECT_TRUE(renderScene(deviceWithLanes(lanes), skyScene(), settings, other).pixels == first.pixels)
        << lanes << " lanes";
    EXPECT_EQ(countOf(other, "sampled_rays"), countOf(stats, "sampled_rays")) << lanes << " lanes";
  }
}

TEST(SampledLight, IsTheSameBitsOnADeviceWithMemoryOfItsOwn) {
  for (const Scene* scene : {&sampledScene(), &skyScene()}) {
    const RenderSettings settings = sampledSettings(*scene, {70, 50});
    const Image first = picture(*scene, settings);
    OpenedDevice device;
    openDevice("", device);
    device.shares_host_memory = false;
    EXPECT_TRUE(picture(*scene, settings, device).pixels == first.pixels);
  }
}

TEST(SampledLight, BandsAreThePictureBitForBit) {
  const struct {
    int samples;
    SampleShading shading;
  } cases[] = {{1, SampleShading::kAll}, {2, SampleShading::kAll}, {4, SampleShading::kShared}};
  for (const auto& [samples, shading] : cases) {
    SCOPED_TRACE(fmt::format("{} samples", samples));
    RenderSettings settings = sampledSettings(sampledScene(), {40, 200});
    settings.samples = samples;
    settings.sample_shading = shading;
    settings.band_height = 1 << 20;
    const Image whole = picture(sampledScene(), settings);
    for (const int height : {kBinSize, 2 * kBinSize}) {
      settings.band_height = height;
      EXPECT_TRUE(picture(sampledScene(), settings).pixels == whole.pixels) << height;
    }
  }
}

/// Expects that the sampled picture is as close to another one as intervals of 0.99 say, and nowhere off by
/// twice of what is allowed. stride: channels of the other picture; if it has intervals, too, they add up.
void expectNear(const Image& sampled, const Image& other, std::size_t stride) {
  std::size_t held = 0, values = 0;
  for (std::size_t i = 0; i < sampled.pixels.size() / kChannels; ++i)
    for (std::size_t c = 0; c < 3; ++c) {
      const float* one = &sampled.pixels[kChannels * i + c];
      const float* two = &other.pixels[stride * i + c];
      const double apart = std::abs(double(one[0]) - two[0]), allowed = std::max(1.0f, one[0]) / 16;
      held += apart <= one[kError] + (stride > kError ? two[kError] : 0.0f);
      ++values;
      ASSERT_LE(apart, 2 * allowed) << "pixel " << i << ", channel " << c;
    }
  EXPECT_GE(double(held), 0.97 * double(values));
}

/// The picture with each light by itself.
Image exactPicture(const Scene& scene, RenderSettings settings) {
  settings.shade.light_error = 0;
  settings.aovs.clear();
  return picture(scene, settings);
}

TEST(SampledLight, ASeedIsAnotherPictureOfTheSameLight) {
  const Scene sky = sceneWith(skyOfLights(1000, 1.5, kCasts));
  for (const Scene* scene : {&sampledScene(), &skyScene(), &sky}) {
    RenderSettings settings = sampledSettings(*scene, {70, 50});
    const Image first = picture(*scene, settings);
    settings.shade.seed = 4'000'000'000u;
    const Image second = picture(*scene, settings);
    expectNear(first, second, kChannels);
    std::size_t same = 0;
    for (std::size_t i = 0; i < first.pixels.size(); i += kChannels)
      same += first.pixels[i + kError] > 0 && first.pixels[i] == second.pixels[i];
    EXPECT_LT(same, first.pixels.size() / kChannels / 10);
  }
}

TEST(SampledLight, OfLightsThatCastNoShadowAsksNoRays) {
  Scene scene = skyScene();
  for (Light& light : scene.lights) light.shadow = light.kind == LightKind::kPoint;
  RenderSettings settings = sampledSettings(scene, {48, 36});
  Stats stats;
  expectNear(renderScene(testDevice(), scene, settings, stats), exactPicture(scene, settings), 3);
  EXPECT_EQ(countOf(stats, "lights_sampled"), scene.lights.size());
  EXPECT_GT(countOf(stats, "sampled_rays"), 0u);
  settings.shade.shadows = ShadowMethod::kOff;
  Stats of_none;
  expectNear(renderScene(testDevice(), scene, settings, of_none), exactPicture(scene, settings), 3);
  EXPECT_EQ(countOf(of_none, "sampled_rays"), 0u);
}

TEST(SampledLight, CropsAndSamplesAreWithinTheirIntervalsOfEachLight) {
  RenderSettings settings = sampledSettings(sampledScene(), {48, 36});
  settings.exposure = 0.5f;
  const auto expectHeld = [&](const char* what) {
    SCOPED_TRACE(what);
    expectNear(picture(sampledScene(), settings), exactPicture(sampledScene(), settings), 3);
  };
  expectHeld("whole");
  settings.crop = Crop{7, 5, 23, 19};
  expectHeld("crop");
  settings.samples = 4;
  expectHeld("shared samples");
  settings.sample_shading = SampleShading::kAll;
  expectHeld("all samples");
}

// Each pixel has the widest interval of any vertex.
TEST(SampledLight, OfVerticesIsWithinTheirIntervalsAndNotCalledProven) {
  RenderSettings settings = sampledSettings(sampledScene(), {48, 36});
  settings.shading = Shading::kGouraud;
  Stats stats;
  const Image sampled = renderScene(testDevice(), sampledScene(), settings, stats);
  expectNear(sampled, exactPicture(sampledScene(), settings), 3);
  EXPECT_LT(stats.light_error.proven, 0.1 * stats.light_error.sum);
  for (std::size_t i = 0; i < sampled.pixels.size(); i += kChannels)
    if (sampled.pixels[i + kError] > 0) {
      ASSERT_LT(sampled.pixels[i + kProof], 0.1f);
    }
}

TEST(SampledLight, GBuffersAreLitAsTheSceneIs) {
  const RenderSettings settings = sampledSettings(sampledScene(), {40, 30});
  Stats stats;
  const GBuffer gbuffer = rasterizeScene(nullptr, sampledScene(), settings, stats);
  EXPECT_TRUE(shadeGBuffer(testDevice(), sampledScene(), gbuffer, settings, stats).pixels ==
              picture(sampledScene(), settings).pixels);
}

TEST(SampledLight, AddsUpWithClustersAndLightsOneByOne) {
  const Scene scene = sceneWith(
      gridOfLights(30, 4, kCasts) + "," + gridOfLights(45, 4, "") +
      R"(, {"type": "spot", "position": [3, 6, 3], "direction": [-1, -2, -1], "cutoff": 80, "intensity": 0.3, "shadow": true})");
  RenderSettings settings = sampledSettings(scene, {64, 48});
  Stats stats;
  const Image both = renderScene(testDevice(), scene, settings, stats);
  EXPECT_EQ(countOf(stats, "lights_sampled"), 900u);
  EXPECT_EQ(countOf(stats, "lights_stood_for"), 2025u);
  EXPECT_EQ(countOf(stats, "lights_exact"), 1u);
  expectNear(both, exactPicture(scene, settings), 3);
  double squares = 0, values = 0, mixed = 0, proven = 0, sum = 0;
  for (std::size_t i = 0; i < both.pixels.size(); i += kChannels)
    for (std::size_t c = 0; c < 3; ++c) {
      const float* value = &both.pixels[i + c];
      const double share = value[kError] / (std::max(1.0f, value[0]) / 16);
      squares += share * share;
      values += value[kError] > 1e-6f;  // the background rounds
      mixed += value[kProof] > 0 && value[kProof] < 1;
      sum += value[kError];
      proven += value[kError] * value[kProof];
    }
  EXPECT_GT(values, 0.25 * 3 * 64 * 48);
  EXPECT_LE(std::sqrt(squares / values), 1);
  EXPECT_GT(mixed, 0.8 * values);
  EXPECT_GT(proven, 0.05 * sum) << "clusters prove theirs";
  EXPECT_LT(proven, 0.95 * sum);
  EXPECT_GT(stats.light_error.proven, 0.05 * stats.light_error.sum);
  EXPECT_LT(stats.light_error.proven, 0.95 * stats.light_error.sum);
}

/// The mean square of the intervals of sampled pixels, as shares of `error` times the larger of `least` and
/// the colour.
double meanSquareShare(const Image& image, float error, float least) {
  double squares = 0;
  int values = 0;
  for (std::size_t i = 0; i < image.pixels.size(); i += kChannels) {
    if (image.pixels[i + kProof] == 1) continue;
    const double share = image.pixels[i + kError] / (error * std::max(least, image.pixels[i]));
    squares += share * share;
    ++values;
  }
  EXPECT_GT(values, 50);
  return squares / values;
}

TEST(SampledLight, ASmallFloorNarrowsTheIntervalsOfDarkPixels) {
  const Scene scene = sceneWith(gridOfLights(30, 0.8, kCasts));
  RenderSettings settings = sampledSettings(scene, {48, 36});
  settings.shade.light_error = 1.0f / 512;
  const auto meanShare = [&] {
    return std::sqrt(meanSquareShare(picture(scene, settings), settings.shade.light_error, 0.05f));
  };
  const double absolute = meanShare();
  settings.shade.light_error_floor = 0.05f;
  const double relative = meanShare();
  EXPECT_LE(relative, 1);
  EXPECT_GT(absolute, 1.5 * relative);
}

// What the fog hides can't be wrong: the mean square of intervals is what is allowed.
TEST(SampledLight, FogNarrowsIntervalsAsItDimsTheLight) {
  Scene scene = sampledScene();
  scene.fog.mode = FogMode::kExp;
  scene.fog.density = glm::vec3(0.3f);
  RenderSettings settings = sampledSettings(scene, {48, 36});
  settings.shade.light_error = 1.0f / 256;
  EXPECT_LE(meanSquareShare(picture(scene, settings), settings.shade.light_error, 1), 1);
}

// Part of a pixel's variance is its own.
TEST(SampledLight, PixelsOfAGroupHaveIntervalsOfTheirOwn) {
  const Image image = picture(sampledScene(), sampledSettings(sampledScene(), {64, 48}));
  int pairs = 0, apart = 0;
  const auto width = [&](std::size_t pixel) {
    const float* value = &image.pixels[pixel * kChannels];
    return value[kError] * (1 - value[kProof]);
  };
  for (std::size_t i = 0; i + 1 < image.pixels.size() / kChannels; i += 2) {
    const float one = width(i), other = width(i + 1);
    if (one == 0 || other == 0) continue;
    ++pairs;
    apart += std::abs(one - other) > 1e-3f * one;
  }
  EXPECT_GT(pairs, 300);
  EXPECT_GT(apart, pairs / 2);
}

TEST(SampledLight, SmallerErrorsAndLargerConfidencesTakeMoreRays) {
  RenderSettings settings = sampledSettings(sampledScene(), {48, 36});
  const auto rays = [&](float error, double confidence) {
    settings.shade.light_error = error;
    settings.shade.confidence = confidence;
    Stats stats;
    renderScene(testDevice(), sampledScene(), settings, stats);
    return countOf(stats, "sampled_rays");
  };
  const std::uint64_t usual = rays(1.0f / 64, 0.99);
  EXPECT_LT(rays(1.0f / 8, 0.99), usual);
  EXPECT_LT(rays(1.0f / 64, 0.5), usual);
  EXPECT_GT(rays(1.0f / 256, 0.99), usual);
}

/// The picture has the bits of one without any error allowed.
void expectOneByOne(const Scene& scene, RenderSettings settings, const char* reason) {
  SCOPED_TRACE(reason);
  Stats stats;
  const Image image = renderScene(testDevice(), scene, settings, stats);
  EXPECT_EQ(countOf(stats, "lights_sampled"), 0u);
  EXPECT_EQ(countOf(stats, std::string("lights_exact_") + reason), scene.lights.size());
  const Image exact = exactPicture(scene, settings);
  for (std::size_t i = 0; i < exact.pixels.size(); ++i)
    ASSERT_EQ(image.pixels[i / 3 * kChannels + i % 3], exact.pixels[i]);
  for (std::size_t i = 0; i < image.pixels.size(); i += kChannels)
    for (std::size_t c = 0; c < 3; ++c) {
      ASSERT_EQ(image.pixels[i + kError + c], 0);
      ASSERT_EQ(image.pixels[i + kProof + c], 1);
    }
}

TEST(SampledLight, FewLightsAreSummedOneByOne) {
  const Scene scene = sceneWith(gridOfLights(7, 8, kCasts));
  RenderSettings settings = sampledSettings(scene, {40, 30});
  settings.shade.always_clusters = false;
  const auto areSampled = [&](const Scene& lit, glm::ivec2 size) {
    return standIns(lit, cameraView(settings.camera, size), materialTraits(lit), settings.shade).sampled;
  };
  ASSERT_FALSE(areSampled(scene, {40, 30}));
  ASSERT_TRUE(areSampled(sceneWith(gridOfLights(150, 8, kCasts)), {1280, 720}));
  expectOneByOne(scene, settings, "as_few");
}

TEST(SampledLight, ShadowsOfMapsAndOfLightsOfASizeAreThoseThatWereAskedFor) {
  const Scene scene = sceneWith(gridOfLights(7, 8, kCasts));
  RenderSettings settings = sampledSettings(scene, {40, 30});
  for (const ShadowMethod method : {ShadowMethod::kHard, ShadowMethod::kPcf, ShadowMethod::kSoft}) {
    settings.shade.shadows = method;
    expectOneByOne(scene, settings, "by_shadow");
  }
  settings.shade.shadows = ShadowMethod::kSoftExact;
  expectOneByOne(sceneWith(gridOfLights(7, 8, R"(, "shadow": true, "radius": 0.1)")), settings, "by_shadow");
  // Without a size, their shadows are known by a ray each.
  Stats stats;
  renderScene(testDevice(), scene, settings, stats);
  EXPECT_EQ(countOf(stats, "lights_sampled"), 49u);
  EXPECT_EQ(countOf(stats, "lights_exact"), 0u);
}

// One group of pixels, half of whose lights a grid hides.
TEST(SampledLight, PixelsWhoseIntervalStaysTooWideAreCounted) {
  const Scene scene = sceneFromJson(
      R"({"camera": {"eye": [0, 0.5, 0.5], "target": [0, 0, 0], "fov_y": 2},
      "objects": [{"primitive": "plane", "scale": 5}, {"primitive": "torus", "translate": [0, 1, 0], "scale": 0.6},
                  {"primitive": "torus", "translate": [0.3, 1.2, 0.2], "scale": 0.4}],
      "lights": [)" +
      gridOfLights(150, 8, kCasts) + "]}");
  RenderSettings settings = sampledSettings(scene, {8, 8});
  settings.shade.light_error = 1e-5f;
  Stats stats;
  const Image image = renderScene(testDevice(), scene, settings, stats);
  EXPECT_EQ(countOf(stats, "pixels_beyond_light_error"), 64u);
  settings.shade.light_error = 1.0f / 16;
  Stats met;
  renderScene(testDevice(), scene, settings, met);
  EXPECT_EQ(countOf(met, "pixels_beyond_light_error"), 0u);
}

}  // namespace
}  // namespace luciole::test
