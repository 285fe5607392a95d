#include "shade/shadow_ways.hpp"
#include "render/plan.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "kernels/probe.hpp"
#include "render_json.hpp"
#include "tools/bench/shadow_scenes.hpp"

// --shadows auto: which lights' shadows are exact, and which are told by maps.
namespace luciole::test {
namespace {

using testing::Contains;
using testing::Each;
using testing::ElementsAre;

constexpr const char* kTwoLamps = R"({
  "camera": {"eye": [3, 2.5, 6], "target": [0, 0.5, 0], "near": 0.1, "far": 50},
  "objects": [{"primitive": "plane", "scale": 20}, {"primitive": "sphere", "translate": [0, 1, 0]},
              {"primitive": "torus", "translate": [1, 0.5, 2], "rotate": [60, 0, 20]}],
  "lights": [{"type": "point", "position": [1, 2, 2], "range": 8, "shadow": true, "color": [1, 0.5, 0.2]},
             {"type": "spot", "position": [-2, 4, 2], "target": [0, 0, 0], "cutoff": 40, "shadow": true},
             {"type": "point", "position": [-1, 3, 1], "range": 9, "color": [0.2, 0.5, 1]}]})";

RenderSettings autoSettings(const Scene& scene, glm::ivec2 size) {
  RenderSettings settings = settingsFor(scene, size);
  settings.shade.shadows = ShadowMethod::kAuto;
  return settings;
}

std::vector<ShadowWay> waysOf(const Scene& scene, const RenderSettings& settings) {
  return planPicture(scene, settings).shade.shadow_ways;
}

TEST(ShadowWays, LightsThatCastNoneHaveNone) {
  Scene scene = sceneFromJson(kTwoLamps);
  EXPECT_EQ(waysOf(scene, autoSettings(scene, {320, 180}))[2], ShadowWay::kNone);
  for (Light& light : scene.lights) light.shadow = false;
  EXPECT_THAT(waysOf(scene, autoSettings(scene, {320, 180})), Each(ShadowWay::kNone));
  scene.objects.clear();
  scene.lights[0].shadow = true;
  EXPECT_EQ(waysOf(scene, autoSettings(scene, {320, 180})).size(), 3u);
}

TEST(ShadowWays, DependOnTheWholePictureAlone) {
  const Scene scene = makeLampHall(30);
  RenderSettings settings = autoSettings(scene, {320, 180});
  const std::vector<ShadowWay> ways = waysOf(scene, settings);
  settings.crop = Crop{200, 100, 50, 40};
  settings.band_height = 64;
  settings.aovs = {Aov::kShadow};
  settings.count_lights = true;
  EXPECT_EQ(waysOf(scene, settings), ways);
}

TEST(ShadowWays, AreMapsWhereTheyAreTwiceAsFast) {
  const std::vector<bool> both{true, true};
  const auto ways = [&](double tree, std::vector<double> beams, std::vector<double> maps) {
    return cheapestWays({.tree = tree, .plan = 0, .beams = std::move(beams), .maps = std::move(maps)}, both);
  };
  EXPECT_THAT(ways(1, {10, 10}, {6, 6}), Each(ShadowWay::kBeams));
  EXPECT_THAT(ways(1, {10, 10}, {20, 4}), ElementsAre(ShadowWay::kBeams, ShadowWay::kMap));
  EXPECT_THAT(ways(1, {10, 10}, {4, 4}), Each(ShadowWay::kMap));
  // The tree must pay, too.
  EXPECT_THAT(ways(29, {10, 10}, {20, 4}), ElementsAre(ShadowWay::kBeams, ShadowWay::kMap));
  EXPECT_THAT(ways(31, {10, 10}, {20, 4}), Each(ShadowWay::kMap));
  EXPECT_THAT(cheapestWays({.tree = 0, .plan = 0, .beams = {1, 1}, .maps = {9, 9}}, {true, false}),
              ElementsAre(ShadowWay::kBeams, ShadowWay::kNone));
}

TEST(ShadowWays, AreExactForManyLampsAndMapsForOneWhoseTreeWouldCostMore) {
  const Scene many = makeLampHall(30);
  EXPECT_THAT(waysOf(many, autoSettings(many, {640, 360})), Each(ShadowWay::kBeams));
  Scene one = makeLampHall(1);
  one.lights[0].kind = LightKind::kSpot;
  one.lights[0].direction = {0, -1, 0};
  one.lights[0].cutoff = 0.5;
  one.lights[0].range = 4;
  EXPECT_THAT(waysOf(one, autoSettings(one, {64, 36})), Each(ShadowWay::kMap));
}

/// A picture of only one of the scene's shadowed lights, by this method.
Image alone(Scene scene, std::size_t light, ShadowMethod method, RenderSettings settings) {
  scene.lights = {scene.lights[light]};
  scene.ambient = glm::vec3(0.0f);
  settings.shade.shadows = method;
  settings.shade.shadow_ways.clear();
  return picture(scene, settings);
}

TEST(ShadowWays, EachLightOfAMixedPictureGivesWhatItGivesByItsOwnMethod) {
  Scene scene = sceneFromJson(kTwoLamps);
  scene.lights.pop_back();
  scene.ambient = glm::vec3(0.0f);
  RenderSettings settings = autoSettings(scene, {160, 90});
  for (const auto& ways :
       {std::vector{ShadowWay::kMap, ShadowWay::kBeams}, std::vector{ShadowWay::kBeams, ShadowWay::kMap}}) {
    settings.shade.shadow_ways = ways;
    const Image mixed = picture(scene, settings);
    const auto methodOf = [&](std::size_t light) {
      return ways[light] == ShadowWay::kMap ? ShadowMethod::kHard : ShadowMethod::kExact;
    };
    const Image first = alone(scene, 0, methodOf(0), settings),
                second = alone(scene, 1, methodOf(1), settings);
    std::size_t covered = 0;
    for (std::size_t i = 0; i < mixed.pixels.size(); ++i) {
      const float sum = first.pixels[i] + second.pixels[i];
      // Sums of two terms times the material's colour, each rounded in either order: four roundings of 2⁻²⁴.
      ASSERT_NEAR(mixed.pixels[i], sum, 4 * 0x1p-24f * std::max(sum, 1e-3f)) << "value " << i;
      covered += sum > 0;
    }
    EXPECT_GT(covered, mixed.pixels.size() / 4);
  }
}

TEST(ShadowWays, AMixedPictureIsTheSameForEveryCullingTileWidthBandAndCrop) {
  const Scene scene = sceneFromJson(kTwoLamps);
  RenderSettings settings = autoSettings(scene, {93, 150});
  settings.aovs = {Aov::kShadow};
  settings.shade.shadow_ways = {ShadowWay::kMap, ShadowWay::kBeams, ShadowWay::kNone};
  const Image expected = picture(scene, settings, deviceWithLanes(16));
  for (const int lanes : widths()) {
    settings.shade.culling = lanes == 16 ? Culling::kNone : Culling::kTiles;
    settings.shade.tile_size = lanes == 1 ? 8 : 4;
    EXPECT_EQ(picture(scene, settings, deviceWithLanes(lanes)).pixels, expected.pixels) << lanes << " lanes";
  }
  settings.shade.culling = Culling::kTiles;
  settings.band_height = 64;
  EXPECT_EQ(picture(scene, settings).pixels, expected.pixels);
  settings.crop = Crop{10, 70, 40, 50};
  const Image crop = picture(scene, settings);
  const std::size_t step = expected.channels.size();
  for (int y = 0; y < 50; ++y)
    for (std::size_t i = 0; i < 40 * step; ++i)
      ASSERT_EQ(crop.pixels[y * 40 * step + i], expected.pixels[((y + 70) * 93 + 10) * step + i])
          << y << " " << i;
}

TEST(ShadowWays, StatisticsSayHowManyLightsAndPairsTookWhich) {
  const Scene scene = sceneFromJson(kTwoLamps);
  RenderSettings settings = autoSettings(scene, {160, 90});
  settings.count_lights = true;
  settings.shade.shadow_ways = {ShadowWay::kMap, ShadowWay::kBeams, ShadowWay::kNone};
  Stats stats;
  renderScene(testDevice(), scene, settings, stats);
  EXPECT_EQ(countOf(stats, "shadow_lights"), 2u);
  EXPECT_EQ(countOf(stats, "shadow_lights_exact"), 1u);
  EXPECT_EQ(countOf(stats, "shadow_lights_by_maps"), 1u);
  const std::uint64_t exact = countOf(stats, "shadow_pairs_exact"),
                      by_maps = countOf(stats, "shadow_pairs_by_maps");
  EXPECT_GT(exact, 0u);
  EXPECT_GT(by_maps, 0u);
  EXPECT_LT(exact + by_maps, countOf(stats, "pixel_lights_evaluated"));
  EXPECT_THAT(stats.features, Contains("exact shadows"));
  EXPECT_THAT(stats.features, Contains("cube shadows"));
}

}  // namespace
}  // namespace luciole::test
