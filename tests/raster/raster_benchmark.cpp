// What the rasterizer costs, with one thread and with two: a picture of 1920 x 1080 with all its planes, and
// depth-only maps of 1024 x 1024, of the scene file in $LUCIOLE_BENCHMARK_SCENE or else Sponza.
#include <benchmark/benchmark.h>
#include <tbb/global_control.h>

#include <cstdlib>

#include "luciole/load_scene.hpp"
#include "raster/rasterize.hpp"
#include "shadow/maps/draw_shadow_maps.hpp"
#include "shadow/maps/shadow_maps.hpp"
#include "shared_files.hpp"

namespace luciole::test {
namespace {

const Scene& scene() {
  static const Scene loaded = [] {
    const char* file = std::getenv("LUCIOLE_BENCHMARK_SCENE");
    Scene read = loadScene(file ? file : sharedScenes() / "sponza_crytek_obj/sponza.obj");
    Light sun;
    sun.kind = LightKind::kDirectional;
    sun.direction = glm::normalize(glm::dvec3(0.3, -1.0, 0.2));
    sun.shadow = true;
    read.lights = {sun};
    return read;
  }();
  return loaded;
}

template <class Draw>
void measure(benchmark::State& state, Draw draw) {
  const std::vector<std::uint32_t> objects = allObjects(scene());
  const tbb::global_control threads(tbb::global_control::max_allowed_parallelism,
                                    std::size_t(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(draw(objects));
}

void picture(benchmark::State& state) {
  const View view = cameraView(scene().cameras.front(), {1920, 1080});
  measure(state, [&](std::span<const std::uint32_t> objects) {
    return rasterize(scene(), objects, view, Shading::kPhong, {true, true, true});
  });
}

void depthOnly(benchmark::State& state) {
  const View view = cameraView(scene().cameras.front(), {1024, 1024});
  const Meshlets meshlets = findMeshlets(scene());
  const std::vector<std::uint32_t> all = allMeshlets(meshlets);
  std::vector<ShadowTexel> texels(std::size_t(view.size.x) * view.size.y);
  measure(state, [&](std::span<const std::uint32_t>) {
    rasterizeDepth(scene(), meshlets, all, view, {}, texels);
    return texels.data();
  });
}

/// All of the scene that the camera sees, as the sun sees it.
void sunShadowMap(benchmark::State& state) {
  const View view = cameraView(scene().cameras.front(), {1920, 1080});
  measure(state, [&](std::span<const std::uint32_t>) {
    ShadowMaps maps = planShadowMaps(scene(), view, ShadowMethod::kHard, {.size = 1024});
    drawNeeded(scene(), std::vector<std::uint32_t>(maps.bin_count, 0), maps);
    return maps;
  });
}

BENCHMARK(picture)->ArgName("threads")->Arg(1)->Arg(2)->UseRealTime()->Unit(benchmark::kMillisecond);
BENCHMARK(depthOnly)->ArgName("threads")->Arg(1)->Arg(2)->UseRealTime()->Unit(benchmark::kMillisecond);
BENCHMARK(sunShadowMap)->ArgName("threads")->Arg(1)->Arg(2)->UseRealTime()->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace luciole::test

BENCHMARK_MAIN();
