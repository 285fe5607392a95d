// What pixels and lights take is what render/memory.hpp says.
#include "render/memory.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <malloc.h>

#include <cstdlib>
#include <fstream>

#include "render/assemble.hpp"
#include "render_json.hpp"

namespace luciole::test {
namespace {

/// A value of /proc/self/status, bytes.
double statusBytes(const std::string& key) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.rfind(key + ":", 0) == 0) return 1024 * std::stod(line.substr(key.size() + 1));
  return 0;
}

/// By how much this process grows at the most while `work` runs; 0 where the system doesn't tell.
template <class Work>
double growth(Work work) {
  malloc_trim(0);                                 // or what was freed before is used again, unseen
  std::ofstream("/proc/self/clear_refs") << "5";  // the peak is what there is now
  const double before = statusBytes("VmRSS"), peak = statusBytes("VmHWM");
  work();
  return peak > before * 1.1 ? 0 : statusBytes("VmHWM") - before;
}

/// A floor that fills the picture, lit and shining.
std::string floorScene(const std::string& lights) {
  return fmt::format(
      R"({{"camera": {{"eye": [0, 5, 0.1], "target": [0, 0, 0]}}, "ambient": 0.1,
    "materials": {{"m": {{"specular": 0.5, "shininess": 8, "emission": 0.1}}}},
    "objects": [{{"primitive": "plane", "scale": 100, "material": "m"}}], {}}})",
      lights);
}

constexpr const char* kSun =
    R"("lights": [{"type": "directional", "direction": [0, -1, 0], "shadow": true}])";

/// Bytes that `settings` say a pixel takes, and those that it does. least_share: of those stated.
void expectBytesPerPixel(const Scene& scene, RenderSettings settings, double least_share = 0.8) {
  settings.camera = scene.cameras.front();
  settings.shade.shadow_limits.size = 64;
  const PicturePlan plan = planPicture(scene, settings);
  const double stated = double(plan.pixel_bytes);
  const glm::ivec2 small(256), large(1024, 2048);
  const auto bytes = [&](glm::ivec2 size) {
    settings.size = size;
    settings.band_height = 1 << 20;
    return growth([&] {
      Stats stats;
      renderBands(
          testDevice(), scene, settings,
          [&](const Image& rows) { EXPECT_EQ(rows.channels.size(), channelCount(settings, plan.planes)); },
          stats);
    });
  };
  bytes(small);  // compiles the kernels
  const double of_small = bytes(small), of_large = bytes(large);
  // Where everything is demanded, as in shared_files.hpp, the figure must be there.
  if (of_large <= 0 && !std::getenv("LUCIOLE_SHARED"))
    GTEST_SKIP() << "this system does not tell a process's peak of memory";
  ASSERT_GT(of_large, 0);
  const double measured = (of_large - of_small) / (double(large.x) * large.y - double(small.x) * small.y);
  testing::Test::RecordProperty("stated", fmt::format("{}", stated));
  testing::Test::RecordProperty("measured", fmt::format("{:.1f}", measured));
  // Beside the pixels' own there are the rasterizer's tables and what the allocators keep of the small
  // picture or give the large one: 16 MiB either way is more than either.
  const double slack = double(1 << 24) / (double(large.x) * large.y);
  EXPECT_LE(measured, stated + slack);
  EXPECT_GE(measured, least_share * stated - slack);
}

TEST(Memory, BytesPerPixelAreAsStated) { expectBytesPerPixel(sceneFromJson(floorScene(kSun)), {}); }

TEST(Memory, BytesPerPixelOfSeveralSamplesWithStatisticsAreAsStated) {
  RenderSettings settings;
  settings.samples = 2;
  settings.sample_shading = SampleShading::kAll;
  settings.count_lights = true;
  expectBytesPerPixel(sceneFromJson(floorScene(kSun)), settings);
}

TEST(Memory, BytesPerPixelOfSeveralSamplesWithCoverageAreAsStated) {
  RenderSettings settings;
  settings.samples = 2;
  settings.sample_shading = SampleShading::kAll;
  settings.alpha = true;
  expectBytesPerPixel(sceneFromJson(floorScene(kSun)), settings);
}

TEST(Memory, BytesPerPixelOfSharedSamplesAreAtMostAsStated) {
  RenderSettings settings;
  settings.samples = 16;
  // No pixel of the floor has a second point, for which there is room.
  expectBytesPerPixel(sceneFromJson(floorScene(kSun)), settings, 0.4);
  settings.alpha = settings.count_lights = true;
  expectBytesPerPixel(sceneFromJson(floorScene(kSun)), settings, 0.4);
}

TEST(Memory, BytesPerPixelOfAllLayersAreAsStated) {
  RenderSettings settings;
  settings.aovs = {Aov::kPosition, Aov::kNormal,     Aov::kDepth,      Aov::kDiffuse,
                   Aov::kMaterial, Aov::kLightCount, Aov::kListLength, Aov::kShadow};
  expectBytesPerPixel(sceneFromJson(floorScene(kSun)), settings);
}

TEST(Memory, BytesPerLightAreAsStated) {
  // Lights that reach nothing, so that no list grows.
  const auto device_bytes = [](int lights) {
    const Scene scene = sceneFromJson(floorScene(fmt::format(
        R"("light_fields": [{{"count": {}, "min": [-9, 900, -9], "max": [9, 901, 9], "range": 0.1}}])",
        lights)));
    RenderSettings settings;
    settings.size = {16, 16};
    settings.camera = scene.cameras.front();
    Stats stats;
    renderScene(testDevice(), scene, settings, stats);
    return double(stats.device_bytes);
  };
  const double measured = (device_bytes(60000) - device_bytes(20000)) / 40000;
  const double stated = double(kBytesPerLight - sizeof(Light));
  EXPECT_LE(measured, stated);
  EXPECT_GE(measured, 0.98 * stated);
}

TEST(Memory, OfADeviceHoldsTheClustersOfLights) {
  const Scene scene = sceneFromJson(
      R"({"camera": {"eye": [0, 5, 0.1], "target": [0, 0, 0]}, "objects": [{"primitive": "plane"}],
    "light_fields": [{"count": 5000, "min": [-1, 1, -1], "max": [1, 2, 1], "no_range": true}]})");
  RenderSettings settings;
  settings.size = {16, 16};
  settings.camera = scene.cameras.front();
  settings.shade.light_error = 1.0f / 64;
  settings.shade.always_clusters = true;
  Stats stats;
  renderScene(testDevice(), scene, settings, stats);
  // The tree's size is that of any so many lights.
  const LightClusters clusters = buildLightClusters(std::vector<UnboundedLight>(5000, {{}, {}, 1}));
  const std::size_t bytes = (clusters.light_rows.size() + clusters.rows.size()) * sizeof(float);
  EXPECT_GT(stats.device_bytes, bytes);
  EXPECT_LT(stats.device_bytes, bytes + 256 * (kGBufferBytesPerPixel + 100))
      << "more than that and the pixels";
}

}  // namespace
}  // namespace luciole::test
