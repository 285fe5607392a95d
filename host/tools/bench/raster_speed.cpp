#include "tools/bench/raster_speed.hpp"

#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/info.h>

#include <algorithm>

#include "base/threads.hpp"
#include "lighting/stats.hpp"
#include "raster/rasterize.hpp"
#include "render/render.hpp"
#include "scene/count_triangles.hpp"
#include "tools/bench/speed_scenes.hpp"

namespace luciole {
namespace {

constexpr glm::ivec2 kGBufferSize(1920, 1080), kMapSize(1024);

double gbufferMilliseconds(const Scene& scene, glm::ivec2 size) {
  RenderSettings settings;
  settings.camera = scene.cameras.front();
  settings.size = size;
  Stats stats;
  rasterizeScene(nullptr, scene, settings, stats);
  return stageTime(stats, Stage::kRasterize);
}

double depthMilliseconds(const Scene& scene, glm::ivec2 size) {
  const View view = cameraView(scene.cameras.front(), size);
  const Meshlets meshlets = findMeshlets(scene);
  const std::vector<std::uint32_t> all = allMeshlets(meshlets);
  std::vector<ShadowTexel> texels(std::size_t(size.x) * size.y);
  return millisecondsOf([&] { rasterizeDepth(scene, meshlets, all, view, {}, texels); });
}

}  // namespace

SpeedTable measureRasterizer(const SpeedInput& input) {
  const Scene hall = input.scene ? Scene{} : makeHall();
  const Scene& scene = input.scene ? *input.scene : hall;
  const glm::ivec2 size = input.size.value_or(kGBufferSize), map_size = input.size.value_or(kMapSize);
  const int threads = std::min(tbb::info::default_concurrency(), int(threadCount()));
  SpeedTable table{.name = "rasterizer",
                   .measured = fmt::format("{}, {} triangles, by one thread and by {}", scene.name,
                                           countTriangles(scene), threads),
                   .columns = {{"milliseconds", "ms", 1},
                               {"one_thread_milliseconds", "one thread, ms", 1},
                               {"times_one_thread", "times one thread", 2}}};
  const std::pair<std::string, std::function<double()>> rows[] = {
      {fmt::format("G-buffer, {} x {}", size.x, size.y), [&] { return gbufferMilliseconds(scene, size); }},
      {fmt::format("depth, {} x {}", map_size.x, map_size.y),
       [&] { return depthMilliseconds(scene, map_size); }}};
  constexpr std::size_t kRuns = 2;  // of each row: by all threads, and by one
  const auto rounds = runInRounds(
      kRuns * std::size(rows), input.repeats, table.name, input.on_progress, [&](std::size_t run) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                        run % kRuns == 0 ? std::size_t(threads) : 1);
        return std::vector{rows[run / kRuns].second()};
      });
  for (std::size_t i = 0; i < std::size(rows); ++i) {
    const RoundFigures &all = rounds[kRuns * i], &one = rounds[kRuns * i + 1];
    table.rows.push_back(
        {rows[i].first, {all.summary(0), one.summary(0), ratio(one.figures[0], all.figures[0])}});
  }
  return table;
}

}  // namespace luciole
