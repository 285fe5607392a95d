#include <fmt/format.h>
#include <gtest/gtest.h>

#include "kernels/probe.hpp"
#include "render_json.hpp"

// The ways to look shadows up, in whole pictures.
namespace luciole::test {
namespace {

constexpr const char* kShadowMethodsScene = R"({
  "camera": {"eye": [3, 2.5, 6], "target": [0, 0.5, 0], "near": 0.1, "far": 50}, "ambient": [0.02, 0.02, 0.03],
  "materials": {"m": {"diffuse": [0.6, 0.5, 0.4], "specular": 0.5, "shininess": 32}},
  "objects": [{"primitive": "plane", "scale": 20, "material": "m"}, {"primitive": "sphere", "translate": [0, 1, 0], "material": "m"},
              {"primitive": "torus", "translate": [1, 0.5, 2], "rotate": [60, 0, 20], "material": "m"}],
  "lights": [{"type": "directional", "direction": [-1, -2, -1], "intensity": 0.5, "angle": 3, "shadow": true},
             {"type": "point", "position": [1, 2, 2], "range": 4, "radius": 0.1, "shadow": true, "color": [1, 0.5, 0.2]},
             {"type": "point", "position": [-1, 3, 1], "range": 9, "color": [0.2, 0.5, 1]},
             {"type": "spot", "position": [-2, 4, 2], "target": [0, 0, 0], "cutoff": 40, "radius": 0.1, "shadow": true}]})";

class ShadowMethods : public testing::TestWithParam<ShadowMethod> {};

TEST_P(ShadowMethods, PictureIsTheSameForEveryCullingTileAndWidth) {
  const Scene scene = sceneFromJson(kShadowMethodsScene);
  const auto render = [&](int lanes, Culling culling, int tile_size) {
    RenderSettings settings;
    settings.size = {93, 70};
    settings.camera = scene.cameras.front();
    settings.aovs = {Aov::kShadow};
    settings.shade.shadows = GetParam();
    settings.shade.shadow_limits.size = 256;
    settings.shade.culling = culling;
    settings.shade.tile_size = tile_size;
    Stats stats;
    return renderScene(deviceWithLanes(lanes), scene, settings, stats).pixels;
  };
  const auto expected = render(16, Culling::kTiles, 4);
  for (const int lanes : widths()) {
    // A program of its own.
    if (lanes == 1 || lanes == 16) {
      EXPECT_EQ(render(lanes, Culling::kNone, 4), expected) << lanes << " lanes";
    }
    for (const int tile_size : {4, 8, 16})
      EXPECT_EQ(render(lanes, Culling::kTiles, tile_size), expected)
          << lanes << " lanes, tiles of " << tile_size;
  }
}

TEST_P(ShadowMethods, ShadowsOfAThousandLightsFitIntoTheMemoryGiven) {
  Scene scene = sceneFromJson(kShadowMethodsScene);
  for (int i = 0; i < 1000; ++i) {
    Light light;
    const int column = i % 32, row = i / 32;
    light.position = {0.37 * column - 6, 0.5 + 0.01 * (i % 7), 0.37 * row - 6};
    light.range = 1.5f;
    light.diffuse = glm::vec3(0.1f);
    light.shadow = true;
    scene.lights.push_back(light);
  }
  RenderSettings settings;
  settings.size = {160, 90};
  settings.camera = scene.cameras.front();
  settings.shade.shadows = GetParam();
  settings.shade.shadow_limits.bytes = std::size_t(64) << 20;
  Stats stats;
  renderScene(testDevice(), scene, settings, stats);
  EXPECT_EQ(countOf(stats, "shadow_lights"), 1003u);
  if (GetParam() == ShadowMethod::kExact || GetParam() == ShadowMethod::kSoftExact) {
    EXPECT_EQ(countOf(stats, "shadow_lights_exact"), 1003u);
    EXPECT_EQ(countOf(stats, "shadow_bytes"), 0u) << "it needs no maps";
    return;
  }
  EXPECT_GT(countOf(stats, "shadow_lights_reduced"), 0u);
  EXPECT_GT(countOf(stats, "shadow_bytes"), 0u);
  EXPECT_LE(countOf(stats, "shadow_bytes"), std::uint64_t(64) << 20);
}

// A search that finds no blocker ends there, whatever the pixels beside it find.
TEST(SoftShadows, OfAPixelDontDependOnItsNeighbours) {
  const Scene scene = loadScene(LUCIOLE_SOURCE_DIR "/scenes/fireflies.json");
  const auto render = [&](int lanes) {
    RenderSettings settings;
    settings.size = {160, 90};
    settings.camera = scene.cameras.front();
    settings.shade.shadows = ShadowMethod::kSoft;
    Stats stats;
    return renderScene(deviceWithLanes(lanes), scene, settings, stats).pixels;
  };
  EXPECT_EQ(render(16), render(1));
}

INSTANTIATE_TEST_SUITE_P(All, ShadowMethods,
                         testing::Values(ShadowMethod::kHard, ShadowMethod::kPcf, ShadowMethod::kSoft,
                                         ShadowMethod::kExact, ShadowMethod::kSoftExact),
                         shadowMethodName);

}  // namespace
}  // namespace luciole::test
