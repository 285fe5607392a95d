#include "lighting/compile_kernels.hpp"

#include <chrono>
#include <limits>
#include <memory>
#include <utility>

#include "base/trace.hpp"
#include "kernels/shared.h"
#include "lighting/light_gbuffer.hpp"

namespace luciole {

void compileKernels(OpenedDevice& device, const FeatureSet& features, const ShadeSettings& settings) {
  GBuffer empty;  // one tile of background
  empty.tiles_x = empty.tiles_y = 1;
  empty.position.assign(3 * kTilePixels, -std::numeric_limits<float>::infinity());
  // All groups must be there, because the kernel loads a row's values before it knows that it is background.
  for (Plane* group : {&empty.normal, &empty.diffuse, &empty.ambient, &empty.emission})
    group->assign(3 * kTilePixels, 0.0f);
  empty.specular.assign(4 * kTilePixels, 0.0f);
  Lighting lighting;
  lighting.math_defines = mathDefines(settings);
  lighting.group_log2 = groupLog2(settings.tile_size);
  // An empty map, so that find_needed.cl is launched, and compiled, too.
  if (features.shadowMaps()) {
    lighting.maps.host.maps.emplace_back();
    lighting.maps.host.faces.emplace_back();
    lighting.maps.host.bin_count = 1;
  }
  borrowMaps(device, lighting.maps);
  if (features.triangleTree())
    prepareBeams(device, {}, std::make_shared<const TriangleTree>(buildTriangleTree({}, {})), nullptr,
                 features.has(Feature::kSoftExact) ? settings.soft_samples : 0, lighting.beams);
  finishLightSet(device, lighting.lights);
  Stats ignored;
  lightGBuffer(device, {}, lighting, {.lights = lighting.lights, .features = features, .gbuffer = empty},
               ignored);
}

std::future<double> startCompiling(OpenedDevice& device, const std::vector<FeatureSet>& programs,
                                   const ShadeSettings& settings) {
  return std::async(std::launch::async, [&device, &programs, &settings] {
    awaitDevice(device);
    const TraceThread thread("kernel compiler");
    const std::int64_t begin = nanosecondsSinceStart();
    for (const FeatureSet& features : programs) compileKernels(device, features, settings);
    return endStage(Stage::kCompileKernels, begin);
  });
}

void awaitKernels(std::future<double>& compiling, OpenedDevice& device, const RenderSettings& settings,
                  Stats& stats) {
  const double milliseconds = timed(stats, Stage::kWaitForKernels, [&] {
    if (settings.on_long_compile && compiling.wait_for(std::chrono::seconds(1)) != std::future_status::ready)
      settings.on_long_compile();
    return compiling.get();
  });
  addStage(stats, Stage::kCompileKernels, milliseconds);
  addStage(stats, Stage::kOpenDevice, std::exchange(device.milliseconds_to_open, 0));
  stats.beside = {Stage::kCompileKernels, Stage::kOpenDevice};
  stats.device = device.description;
}

}  // namespace luciole
