// What goes to the device and back for a picture, on a device whose memory is the host's and on one with
// memory of its own.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "render_json.hpp"

namespace luciole::test {
namespace {

/// Shadows of every kind, some of them soft, and lights for the lists.
constexpr const char* kTrafficScene =
    R"({"camera": {"eye": [3, 2, 5], "target": [0, 0.5, 0], "fov_y": 60}, "ambient": 0.1,
  "materials": {"m": {"diffuse": [0.6, 0.5, 0.4], "specular": 0.5, "shininess": 32}},
  "objects": [{"primitive": "plane", "scale": 20, "segments": 9, "material": "m"}, {"primitive": "sphere", "translate": [0, 1, 0], "material": "m"},
              {"primitive": "torus", "translate": [1, 0.5, 2], "rotate": [60, 0, 20], "material": "m"}],
  "lights": [{"type": "directional", "direction": [-1, -2, -1], "intensity": 0.5, "shadow": true, "angle": 3},
             {"type": "point", "position": [1, 2, 2], "radius": 0.1, "range": 4, "shadow": true, "color": [1, 0.5, 0.2]},
             {"type": "spot", "position": [-2, 4, 2], "target": [0, 0, 0], "cutoff": 40, "exponent": 4, "shadow": true}],
  "light_fields": [{"count": 100, "seed": 3, "min": [-4, 0, -4], "max": [4, 2, 4], "range": 0.8, "intensity": 0.5}]})";

/// A device with memory of its own, as far as this program is told.
OpenedDevice& deviceApart() {
  static OpenedDevice device;
  static const bool opened = (openDevice("", device), device.shares_host_memory = false, true);
  (void)opened;
  return device;
}

RenderSettings sampledSettings(const Scene& scene, ShadowMethod method, int samples) {
  RenderSettings settings;
  settings.size = {100, 150};
  settings.camera = scene.cameras.front();
  settings.samples = samples;
  settings.shade.shadows = method;
  settings.shade.shadow_limits.size = 256;
  return settings;
}

Traffic trafficOfPicture(OpenedDevice& device, const Scene& scene, const RenderSettings& settings) {
  Stats stats;
  renderScene(device, scene, settings, stats);
  return stats.traffic;
}

struct TrafficByMethod : testing::TestWithParam<ShadowMethod> {};

TEST_P(TrafficByMethod, PictureIsTheSameWhereTheDeviceHasMemoryOfItsOwn) {
  const Scene scene = sceneFromJson(kTrafficScene);
  RenderSettings settings = sampledSettings(scene, GetParam(), 2);
  settings.band_height = 64;
  settings.aovs = {Aov::kLightCount, Aov::kShadow};
  Stats stats;
  EXPECT_EQ(renderScene(deviceApart(), scene, settings, stats).pixels,
            renderScene(testDevice(), scene, settings, stats).pixels);
}

INSTANTIATE_TEST_SUITE_P(Methods, TrafficByMethod,
                         testing::Values(ShadowMethod::kOff, ShadowMethod::kHard, ShadowMethod::kPcf,
                                         ShadowMethod::kSoft, ShadowMethod::kExact,
                                         ShadowMethod::kSoftExact));

TEST(Traffic, NothingIsCopiedWhereMemoryIsShared) {
  OpenedDevice device;
  openDevice("", device);
  if (!device.shares_host_memory) GTEST_SKIP() << "the default device has memory of its own";
  const Scene scene = sceneFromJson(kTrafficScene);
  const Traffic traffic = trafficOfPicture(device, scene, sampledSettings(scene, ShadowMethod::kPcf, 2));
  EXPECT_EQ(traffic.bytes_up, 0u);
  EXPECT_EQ(traffic.bytes_down, 0u);
  EXPECT_GT(traffic.bytes_made, 0u);
}

TEST(Traffic, OnlyShadowTexelsThatWereDrawnGoUp) {
  const Scene scene = sceneFromJson(kTrafficScene);
  constexpr int kSamples = 8;
  RenderSettings settings = sampledSettings(scene, ShadowMethod::kPcf, kSamples);
  settings.shade.shadow_limits.size = 512;
  settings.sample_shading = SampleShading::kAll;
  Stats with;
  renderScene(deviceApart(), scene, settings, with);
  const auto shadow_bytes = std::find_if(with.counts.begin(), with.counts.end(),
                                         [](const auto& count) { return count.first == "shadow_bytes"; });
  ASSERT_NE(shadow_bytes, with.counts.end());
  settings.shade.shadows = ShadowMethod::kOff;
  const Traffic without = trafficOfPicture(deviceApart(), scene, settings);
  // Beside texels: the triangles' normals and the lift, for each sample of whole tiles; the shadow maps' 9
  // faces, and 4 KiB for a tile by which kernels are compiled. A bin is drawn anew where a sample looks
  // farther there than all before: of samples in a random order that is the k-th with a chance of 1/k, and 1
  // + 1/2 + … + 1/8 = 2.7.
  constexpr std::uint64_t kPlanes = 2 * 4 * 112 * 160 * kSamples, kOther = 9 * 48 * kSamples + 4096;
  EXPECT_LT(with.traffic.bytes_up - without.bytes_up, kSamples / 2 * shadow_bytes->second + kPlanes + kOther);
  EXPECT_GT(with.traffic.bytes_up - without.bytes_up, shadow_bytes->second);
}

/// A leaf whose opacity is its cutoff: nothing but a lookup tells that it is solid.
constexpr const char* kLeaf =
    R"({"primitive": "plane", "translate": [0.5, 1.5, 1], "rotate": [20, 0, 10], "material": "leaf"}, )";

// Neither words of pairs nor lists come down or go up. Without culling each tile has all lights, and 32 bytes
// of words for each of them: as much is moved as with short lists, and no more than in a picture without
// shadows but for what is said below.
TEST(Traffic, ExactShadowsStayOnTheDevice) {
  constexpr std::uint64_t kPasses = 2, kTiles = kPasses * (112 * 160 / kTilePixels);
  for (const ShadowMethod method : {ShadowMethod::kExact, ShadowMethod::kSoftExact})
    for (const bool holes : {false, true}) {
      std::string text = kTrafficScene;
      if (holes) {
        text.insert(text.find(R"({"primitive")"), kLeaf);
        text.insert(text.find(R"("m": )"),
                    R"("leaf": {"alpha": 0.5, "alpha_cutoff": 0.5, "double_sided": true}, )");
      }
      const Scene scene = sceneFromJson(text.c_str());
      RenderSettings settings = sampledSettings(scene, method, int(kPasses));
      settings.sample_shading = SampleShading::kAll;
      const Traffic by_lists = trafficOfPicture(deviceApart(), scene, settings);
      settings.shade.culling = Culling::kNone;
      Stats stats;
      renderScene(deviceApart(), scene, settings, stats);
      settings.shade.shadows = ShadowMethod::kOff;
      const Traffic without = trafficOfPicture(deviceApart(), scene, settings);
      // Pairs that only textures can tell: at most those that rays decide.
      const std::uint64_t rays = countOf(stats, "shadow_rays"),
                          open = !holes                           ? 0
                                 : method == ShadowMethod::kExact ? rays
                                                                  : countOf(stats, "soft_pairs_by_rays");
      EXPECT_EQ(rays > 0, holes || method == ShadowMethod::kSoftExact);
      EXPECT_LE(stats.traffic.bytes_up, by_lists.bytes_up + sizeof(float) * open);
      // Of each tile four counts and that of open pairs, of which each has a pixel and a light. One more tile
      // is that by which kernels are compiled; the picture without may have found its own compiled.
      constexpr std::uint64_t kColors = 3 * sizeof(float) * kTilePixels;
      EXPECT_LE(stats.traffic.bytes_down, without.bytes_down + kColors + 20 * (kTiles + 1) + 8 * open);
    }
}

}  // namespace
}  // namespace luciole::test
