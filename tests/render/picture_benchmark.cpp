// What the pictures of scenes/ cost and how wrong they are: the README's table. Run it alone on a quiet
// machine:
//   build/tests/picture_benchmark --benchmark_repetitions=5 --benchmark_report_aggregates_only
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>

#include "kernels/shared.h"
#include "lighting/light_gbuffer.hpp"
#include "luciole/load_scene.hpp"
#include "reference/reference.hpp"
#include "render/render.hpp"

namespace luciole {
namespace {

OpenedDevice& device() {
  static OpenedDevice opened;
  static const bool once = (openDevice("", opened), true);
  (void)once;
  return opened;
}

RenderSettings settingsOf(const Scene& scene, glm::ivec2 size) {
  RenderSettings settings;
  settings.camera = scene.cameras.front();
  settings.size = size;
  return settings;
}

/// Largest and mean difference from the double-precision reference, shadows off in both, as shares of the
/// picture's maximum.
void reportError(benchmark::State& state, const Scene& scene) {
  RenderSettings settings = settingsOf(scene, {320, 180});
  settings.shade.shadows = ShadowMethod::kOff;
  Stats stats;
  const GBuffer gbuffer = rasterizeScene(nullptr, scene, settings, stats);
  const Image ours = renderScene(device(), scene, settings, stats);
  const Image truth = referenceShade(scene, gbuffer, {});
  double most = 0, worst = 0, sum = 0;
  for (std::size_t i = 0; i < truth.pixels.size(); ++i) {
    const double error = std::abs(double(ours.pixels[i]) - truth.pixels[i]);
    most = std::max(most, double(truth.pixels[i]));
    worst = std::max(worst, error);
    sum += error;
  }
  state.counters["max_error"] = worst / most;
  state.counters["mean_error"] = sum / double(truth.pixels.size()) / most;
}

/// A 1280 x 720 picture, loaded and compiled before: the time of each stage, and of all of them.
void renderPicture(benchmark::State& state, const std::string& name) {
  const Scene scene = loadScene(LUCIOLE_SOURCE_DIR "/scenes/" + name + ".json");
  const RenderSettings settings = settingsOf(scene, {1280, 720});
  Stats stats;
  renderScene(device(), scene, settings, stats);
  stats.stages.clear();
  for (auto _ : state) renderScene(device(), scene, settings, stats);
  for (const auto& [stage, milliseconds] : stats.stages)
    state.counters[stageName(stage)] = benchmark::Counter(milliseconds, benchmark::Counter::kAvgIterations);
  reportError(state, scene);
}

/// Every one of 64 lights on every one of 512 x 512 pixels, Phong with an exponent per pixel, range window.
void shadeEveryPair(benchmark::State& state) {
  constexpr int kPixels = 512 * 512, kLights = 64;
  Scene scene;
  std::uint32_t bits = 1;
  const auto random = [&] { return float((bits = bits * 1664525u + 1013904223u) >> 8) / float(1 << 24); };
  for (int i = 0; i < kLights; ++i) {
    Light light;
    light.position = {random() * 10 - 5, random() * 10 - 5, -5 - random() * 10};
    light.range = 30;
    scene.lights.push_back(light);
  }
  GBuffer gbuffer;
  gbuffer.width = gbuffer.height = 512;
  gbuffer.tiles_x = gbuffer.tiles_y = 512 / kTileSize;
  gbuffer.position.resize(3 * kPixels);
  gbuffer.normal.resize(3 * kPixels);
  gbuffer.diffuse.assign(3 * kPixels, 0.5f);
  gbuffer.specular.assign(4 * kPixels, 0.5f);
  for (int i = 0; i < kPixels; ++i) {
    const glm::vec3 position(random() * 10 - 5, random() * 10 - 5, -5 - random() * 10);
    const glm::vec3 normal = glm::normalize(glm::vec3(random() - 0.5f, random() - 0.5f, random() + 0.01f));
    for (int c = 0; c < 3; ++c) {
      gbuffer.position[i + c * kPixels] = position[c];
      gbuffer.normal[i + c * kPixels] = normal[c];
    }
    gbuffer.specular[i + 3 * kPixels] = 1 + 100 * random();
  }
  FeatureSet features;
  for (const Feature used :
       {Feature::kPointLights, Feature::kSmoothWindow, Feature::kPhong, Feature::kSpecular})
    features.set(used);
  Lighting lighting;
  Stats stats;
  prepareLighting(device(), scene, gbuffer.camera, View(), features, ShadeSettings(), lighting, stats);
  lightGBuffer(device(), scene, lighting, {lighting.lights, features, gbuffer}, stats);
  for (auto _ : state) {
    stats.stages.clear();
    lightGBuffer(device(), scene, lighting, {lighting.lights, features, gbuffer}, stats);
    for (const auto& [stage, milliseconds] : stats.stages)
      if (stage == Stage::kShade) state.SetIterationTime(milliseconds / 1000);
  }
  state.SetItemsProcessed(state.iterations() * kPixels * kLights);
}

BENCHMARK(shadeEveryPair)->UseManualTime()->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(renderPicture, fireflies, "fireflies")->UseRealTime()->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(renderPicture, underwater, "underwater")->UseRealTime()->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(renderPicture, colonnade, "colonnade")->UseRealTime()->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(renderPicture, city, "city")->UseRealTime()->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(renderPicture, spheres, "spheres")->UseRealTime()->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(renderPicture, cornell, "cornell")->UseRealTime()->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace luciole

BENCHMARK_MAIN();
