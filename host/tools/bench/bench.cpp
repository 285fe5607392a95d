#include "tools/bench/bench.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "luciole/error.hpp"
#include "tools/bench/anti_aliasing.hpp"
#include "tools/bench/culled_shading.hpp"
#include "tools/bench/given_gbuffer.hpp"
#include "tools/bench/light_errors.hpp"
#include "tools/bench/many_lights.hpp"
#include "tools/bench/memory_use.hpp"
#include "tools/bench/picture_time.hpp"
#include "tools/bench/raster_speed.hpp"
#include "tools/bench/shading_rate.hpp"
#include "tools/bench/shadow_errors.hpp"
#include "tools/bench/shadowed_lights.hpp"
#include "tools/bench/start_time.hpp"

namespace luciole {
namespace {

constexpr const char* kCullAndShade = "cull and shade";

struct SpeedMeasurement {
  const char* name;  ///< by which it is chosen; one may choose several
  SpeedTable (*measure)(const SpeedInput&);
  bool only_by_name = false;  ///< too long to be part of all
};
constexpr SpeedMeasurement kSpeed[] = {
    {"shading rate", measureShadingRate},
    {"culling and shading", measureCulledShading},
    {kCullAndShade, measureGivenGBuffer},
    {"many lights", measureManyLights},
    {kLightErrors, measureLightErrors, true},
    {kShadowedLights, measureShadowedLights, true},
    {"anti-aliasing", measureAntiAliasing},
    {"shadow errors", measureShadowErrors},
    {"rasterizer", measureRasterizer},
    {"start", measureStart},
    {"memory", measureMemory},
    {"picture", measurePictures},
    {"picture", measureFeatureCosts},
};

}  // namespace

std::vector<std::string> benchNames() {
  std::vector<std::string> names{"shading", "models", "shadows", "samples"};
  for (const SpeedMeasurement& one : kSpeed)
    if (names.back() != one.name) names.push_back(one.name);
  return names;
}

BenchResult runBench(const Scene& scene, const BenchSettings& settings, const BenchChoice& choice) {
  const auto chosen = [&](const std::string& name) {
    return choice.only.empty() ||
           std::find(choice.only.begin(), choice.only.end(), name) != choice.only.end();
  };
  if (!choice.given && std::find(choice.only.begin(), choice.only.end(), kCullAndShade) != choice.only.end())
    throw InputError(fmt::format("--only \"{}\": needs --gbuffer and --scene", kCullAndShade));
  OpenedDevice device;
  openDevice(settings.device, device);
  const bool draws = !choice.given || choice.only != std::vector<std::string>{kCullAndShade};
  const Scene& described = draws ? scene : choice.given->scene;
  Stats stats;
  describeScene(described, {}, stats);
  BenchResult result{.machine = describeMachine(device),
                     .scene = described.name,
                     .triangles = stats.triangles,
                     .lights = stats.lights,
                     .width = draws ? settings.picture.size.x : choice.given->gbuffer.width,
                     .height = draws ? settings.picture.size.y : choice.given->gbuffer.height,
                     .repeats = settings.repeats};
  if (choice.given && chosen(kCullAndShade))
    result.gbuffer = {.file = choice.given->file,
                      .scene = choice.given->scene.name,
                      .lights = choice.given->scene.lights.size(),
                      .width = choice.given->gbuffer.width,
                      .height = choice.given->gbuffer.height,
                      .model = modelName(choice.given->model)};
  std::vector<VariantGroup> groups = benchVariants(scene, device.description.lanes, choice.shadow_size);
  std::erase_if(groups, [&](const VariantGroup& group) { return !chosen(group.chosen_by); });
  if (!groups.empty()) result.groups = measureVariants(scene, groups, settings);
  const SpeedInput input{.device = device,
                         .device_selector = settings.device,
                         .scene = choice.named_scene ? &scene : nullptr,
                         .given = choice.given ? &*choice.given : nullptr,
                         .size = choice.size,
                         .shadow_size = choice.shadow_size,
                         .repeats = settings.repeats,
                         .scene_path = choice.scene_path,
                         .picture_options = choice.picture_options,
                         .program = choice.program,
                         .on_progress = settings.on_progress};
  for (const SpeedMeasurement& one : kSpeed)
    if (chosen(one.name) && (choice.given || one.name != std::string_view(kCullAndShade)) &&
        !(one.only_by_name && choice.only.empty()))
      result.speed.push_back(one.measure(input));
  if (result.groups.empty() && result.speed.empty())
    throw InputError(fmt::format("--only {}: {} has no shadows", choice.only.front(), scene.name));
  return result;
}

}  // namespace luciole
