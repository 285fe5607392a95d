// Pictures with exact shadows of lights of a size. That each pair is what brute force says is tested beside
// beams (beam_shadows_test.cpp), and behind holes (hole_masks_test.cpp); the penumbra of an edge beside maps'
// (soft_shadows_test.cpp).
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "render_json.hpp"
#include "shadow/exact/light_samples.hpp"

namespace luciole::test {
namespace {

std::string softScene(const std::string& lights) {
  return R"({"camera": {"eye": [3, 2.5, 6], "target": [0, 0.5, 0], "near": 0.1, "far": 50}, "ambient": 0.02,
    "materials": {"m": {"diffuse": [0.6, 0.5, 0.4], "double_sided": true}},
    "objects": [{"primitive": "plane", "scale": 20, "material": "m"},
                {"primitive": "sphere", "translate": [0, 1, 0], "material": "m"},
                {"primitive": "torus", "translate": [1, 0.5, 2], "rotate": [60, 0, 20], "material": "m"}],
    "lights": [)" +
         lights + "]}";
}

constexpr const char* kSizedLights =
    R"({"type": "directional", "direction": [-1, -2, -1], "intensity": 0.5, "angle": 3, "shadow": true},
       {"type": "point", "position": [1, 2, 2], "range": 4, "radius": 0.2, "shadow": true},
       {"type": "spot", "position": [-2, 4, 2], "target": [0, 0, 0], "cutoff": 40, "radius": 0.1, "shadow": true})";
constexpr const char* kPointLights =
    R"({"type": "directional", "direction": [-1, -2, -1], "intensity": 0.5, "shadow": true},
       {"type": "point", "position": [1, 2, 2], "range": 4, "shadow": true},
       {"type": "spot", "position": [-2, 4, 2], "target": [0, 0, 0], "cutoff": 40, "shadow": true})";

RenderSettings softSettings(const Scene& scene, int samples) {
  RenderSettings settings;
  settings.size = {97, 70};
  settings.camera = scene.cameras.front();
  settings.shade.shadows = ShadowMethod::kSoftExact;
  settings.shade.soft_samples = samples;
  settings.aovs = {Aov::kShadow};
  return settings;
}

Image rendered(const Scene& scene, const RenderSettings& settings) {
  Stats stats;
  return renderScene(testDevice(), scene, settings, stats);
}

TEST(SoftExact, OfLightsWithoutASizeIsExactBitForBit) {
  const Scene scene = sceneFromJson(softScene(kPointLights));
  for (const int samples : {1, 16}) {
    RenderSettings settings = softSettings(scene, samples);
    const Image soft = rendered(scene, settings);
    settings.shade.shadows = ShadowMethod::kExact;
    EXPECT_EQ(rendered(scene, settings).pixels, soft.pixels);
  }
}

TEST(SoftExact, CropsAreCutOutOfThePicture) {
  const Scene scene = sceneFromJson(softScene(kSizedLights));
  for (const int samples : {1, 3}) {
    RenderSettings settings = softSettings(scene, 7);
    settings.samples = samples;
    const Image whole = rendered(scene, settings);
    settings.crop = Crop{21, 13, 50, 33};
    const Image part = rendered(scene, settings);
    const std::size_t channels = whole.channels.size();
    for (int y = 0; y < part.height; ++y)
      for (std::size_t i = 0; i < std::size_t(part.width) * channels; ++i)
        ASSERT_EQ(part.pixels[std::size_t(y * part.width) * channels + i],
                  whole.pixels[std::size_t((y + 13) * whole.width + 21) * channels + i])
            << "row " << y << ", " << samples << " samples";
  }
}

TEST(SoftExact, StatsCountWhatRaysDecideAndWhatNot) {
  const Scene scene = sceneFromJson(softScene(kSizedLights));
  RenderSettings settings = softSettings(scene, 5);
  settings.count_lights = true;
  Stats stats;
  renderScene(testDevice(), scene, settings, stats);
  const std::uint64_t by_rays = countOf(stats, "soft_pairs_by_rays"), lit = countOf(stats, "soft_pairs_lit"),
                      dark = countOf(stats, "soft_pairs_dark");
  EXPECT_GT(by_rays, 1000u);
  EXPECT_GT(lit, by_rays);
  EXPECT_GT(dark, 0u);
  EXPECT_EQ(countOf(stats, "shadow_rays"), 5 * by_rays);
  settings.shade.shadows = ShadowMethod::kExact;
  Stats exact;
  renderScene(testDevice(), scene, settings, exact);
  for (const char* name : {"soft_pairs_by_rays", "soft_pairs_lit", "soft_pairs_dark", "shadow_rays"})
    EXPECT_EQ(countOf(exact, name), 0u) << name;
}

// All surfaces are inside the light, so nothing is between them and it.
TEST(SoftExact, OfALightThatHoldsTheSceneNothingIsHidden) {
  for (const char* radius : {"100", "1e9", "1e17"}) {
    const Scene scene = sceneFromJson(softScene(
        fmt::format(R"({{"type": "point", "position": [1, 2, 2], "radius": {}, "shadow": true}})", radius)));
    RenderSettings settings = softSettings(scene, 16);
    settings.aovs = {};
    const Image soft = rendered(scene, settings);
    settings.shade.shadows = ShadowMethod::kOff;
    EXPECT_EQ(rendered(scene, settings).pixels, soft.pixels) << radius;
  }
}

// In a surface, on an edge of it, in a solid, under the ground, and with the largest sun and a sun without a
// size: a share of the light is one.
TEST(SoftExact, SharesAreSharesWhereverLightsAre) {
  for (
      const char* light :
      {R"({"type": "point", "position": [0, 0, 0], "radius": 0.5, "shadow": true})",
       R"({"type": "point", "position": [0, 2, 0], "radius": 1e-9, "shadow": true})",
       R"({"type": "point", "position": [0, 1, 0], "radius": 0.9, "shadow": true})",
       R"({"type": "point", "position": [0, -3, 0], "radius": 4, "shadow": true})",
       R"({"type": "point", "position": [1e18, 1e18, 0], "radius": 1e17, "shadow": true})",
       R"({"type": "spot", "position": [0, 3, 0], "direction": [0, -1, 0], "cutoff": 90, "radius": 2.9, "shadow": true})",
       R"({"type": "directional", "direction": [1, -1, 1], "angle": 90, "shadow": true})",
       R"({"type": "directional", "direction": [0, -1, 0], "angle": 1e-12, "shadow": true})",
       R"({"type": "directional", "direction": [0, -1, 0], "angle": 0, "shadow": true})"}) {
    const Scene scene = sceneFromJson(softScene(light));
    const Image image = rendered(scene, softSettings(scene, 4));
    const std::size_t channels = image.channels.size(), shadow = channelIndex(image, "shadow");
    std::set<float> shares;
    for (std::size_t i = 0; i < image.pixels.size(); i += channels) {
      for (std::size_t c = 0; c < channels; ++c) ASSERT_TRUE(std::isfinite(image.pixels[i + c])) << light;
      shares.insert(image.pixels[i + shadow]);
    }
    EXPECT_GE(*shares.begin(), 0) << light;
    EXPECT_LE(*shares.rbegin(), 1) << light;
    EXPECT_LE(shares.size(), 5u) << light;
  }
}

// The share of a quarter of the unit square that each run of 4^m samples has is a quarter.
TEST(LightSamples, RunsAreNets) {
  const std::vector<LightSample> samples = makeLightSamples();
  for (const std::size_t run : {4, 16, 256, 1024}) {
    const int side = int(std::lround(std::sqrt(double(run))));
    for (std::size_t first = 0; first < samples.size(); first += run) {
      std::set<int> cells;
      for (std::size_t i = first; i < first + run; ++i) {
        const double turn = std::atan2(samples[i].sine, samples[i].cosine) / (2 * 3.14159265358979323846);
        cells.insert(int(samples[i].share * float(side)) * side + int((turn < 0 ? turn + 1 : turn) * side));
      }
      ASSERT_EQ(cells.size(), run) << "from " << first;
    }
  }
}

TEST(LightSamples, PatternsDependOnPointAndLightAndLieInTheSamples) {
  const std::vector<LightSample> samples = makeLightSamples();
  const glm::vec3 start(1, 2, 3);
  const auto at = [&](int count, const glm::vec3& from, std::uint32_t light) {
    const auto pattern = patternOf(samples, count, from, light);
    EXPECT_EQ(pattern.size(), std::size_t(count));
    EXPECT_GE(pattern.data(), samples.data());
    EXPECT_LE(pattern.data() + count, samples.data() + samples.size());
    return pattern.data();
  };
  std::set<const LightSample*> of_points, of_lights;
  for (int i = 0; i < 1000; ++i) {
    of_points.insert(at(16, start + glm::vec3(0, 0, 1e-6f * float(i)), 0));
    of_lights.insert(at(16, start, std::uint32_t(i)));
    at(1 + i, start, 7);
  }
  at(kMostSoftSamples, start, 7);
  // Of 4096 patterns 1000 choices at random take 887 ± 10.
  EXPECT_GT(of_lights.size(), 840u);
  EXPECT_LT(of_lights.size(), 935u);
  EXPECT_GT(of_points.size(), 300u) << "floats 2^-22 apart";
  EXPECT_EQ(at(16, start, 3), at(16, start, 3));
}

TEST(LightSamples, LieOnTheNearSideOfTheSphereOrInTheSunsDisc) {
  const std::vector<LightSample> samples = makeLightSamples();
  const glm::vec3 start(30, -7, 12);
  std::vector<float4> places(1024);
  for (const float size : {1e-3f, 1.0f, 50.0f}) {
    const BeamLight sphere{{-20, 40, 33, 1}, 0, 1, size, 0};
    ASSERT_TRUE(placeSamples(sphere, start, std::span(samples).first(1024), places));
    const glm::dvec3 middle(-20, 40, 33), way = middle - glm::dvec3(start);
    for (const float4& place : places) {
      const glm::dvec3 at = glm::dvec3(place.x, place.y, place.z) - middle;
      // Each coordinate is rounded, by 2^-24 of less than 128.
      EXPECT_NEAR(glm::length(at), size, std::sqrt(3.0) * 0x1p-17 + 1e-6 * size);
      EXPECT_LT(glm::dot(at, way), size * 1e-3 * glm::length(way));
    }
  }
  EXPECT_FALSE(placeSamples({{30, -7, 13, 1}, 0, 1, 1, 0}, start, std::span(samples).first(1024), places));
  const BeamLight sun{{0, 0.6f, -0.8f, 0}, 0, 1, 0.1f, 0};
  ASSERT_TRUE(placeSamples(sun, start, std::span(samples).first(1024), places));
  for (const float4& place : places) {
    const glm::dvec3 at(place.x, place.y, place.z);
    EXPECT_NEAR(glm::length(at), 1, 0x1p-23);
    EXPECT_LE(glm::length(at - glm::dvec3(0, 0.6f, -0.8f)), 0.1 + 0x1p-22);
  }
}

}  // namespace
}  // namespace luciole::test
