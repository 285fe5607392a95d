#include "render/measure_exposure.hpp"

#include <cmath>
#include <cstddef>
#include <vector>

#include "base/trace.hpp"
#include "image/exposure.hpp"

namespace luciole {

double measureExposure(OpenedDevice& device, const Scene& scene, const RenderSettings& settings, Stats& stats,
                       KeptPicture* kept) {
  RenderSettings small;
  small.size = measuringSize(settings.size);
  small.camera = settings.camera;
  small.shading = settings.shading;
  small.shade = settings.shade;
  small.surfaces = settings.surfaces;
  small.aovs = {Aov::kDepth};
  small.on_long_compile = settings.on_long_compile;
  Stats of_small;
  Image picture;
  const TraceSpan span(stageName(Stage::kMeasureExposure));
  const double milliseconds =
      millisecondsOf([&] { picture = renderScene(device, scene, small, of_small, kept); });
  // Waiting for the device and kernels doesn't count: the picture itself would have to.
  const double waited =
      stageTime(of_small, Stage::kWaitForDevice) + stageTime(of_small, Stage::kWaitForKernels);
  addStage(stats, Stage::kMeasureExposure, milliseconds - waited);
  for (const auto& [stage, of_stage] : of_small.stages)
    if (isStart(stage)) addStage(stats, stage, of_stage);
  stats.traffic.bytes_up += of_small.traffic.bytes_up;
  stats.traffic.bytes_down += of_small.traffic.bytes_down;
  stats.traffic.bytes_made += of_small.traffic.bytes_made;

  const std::size_t channels = picture.channels.size();  // R G B Z
  std::vector<glm::vec3> colors;
  for (std::size_t i = 0; i < picture.pixels.size(); i += channels) {
    const float* pixel = picture.pixels.data() + i;
    if (std::isfinite(pixel[3])) colors.emplace_back(pixel[0], pixel[1], pixel[2]);
  }
  return suitableExposure(colors);
}

double measureExposure(const Image& picture, const GBuffer& gbuffer) {
  const float* depth = gbuffer.position.data() + 2 * gbuffer.pixels();
  const float* pixel = picture.pixels.data();
  std::vector<glm::vec3> colors;
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x, pixel += picture.channels.size())
      if (std::isfinite(depth[gbuffer.index(x, y)])) colors.emplace_back(pixel[0], pixel[1], pixel[2]);
  }
  return suitableExposure(colors);
}

}  // namespace luciole
