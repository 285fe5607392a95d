#include "tools/bench/lit_stage.hpp"

#include <fmt/format.h>

#include <utility>

#include "lighting/stats.hpp"
#include "luciole/error.hpp"
#include "raster/visible_points.hpp"
#include "render/render.hpp"
#include "scene/bounds.hpp"
#include "scene/lights/light_range.hpp"
#include "tools/figures/checked_pixels.hpp"

namespace luciole {

LitStage setStage(Scene scene, glm::ivec2 size, std::size_t judged_pixels) {
  LitStage stage{std::move(scene), {}, {}, chooseCheckedPixels(size, judged_pixels, 0).pixels};
  RenderSettings settings;
  settings.size = size;
  settings.camera = stage.scene.cameras.front();
  Stats ignored;
  stage.gbuffer = rasterizeScene(nullptr, stage.scene, settings, ignored);
  stage.seen = visiblePoints(stage.scene, settings.camera, size, kMeasuredPlaces, 0);
  if (stage.seen.empty())
    throw InputError(
        fmt::format("{}: its camera sees nothing that lights could be put around", stage.scene.name));
  return stage;
}

void placeLights(LitStage& stage, FieldShape shape, std::uint64_t lights) {
  const glm::dvec3 eye(stage.gbuffer.camera.camera_to_world[3]);
  LightField field = fieldInBox(shape, seenBox(stage.seen, eye));
  field.count = lights;
  clearLights(stage.scene);
  expandLightField(field, stage.scene);
  spreadEverywhere(stage.scene.lights, stage.seen);
}

double lightingTime(const Stats& stats) {
  double sum = 0;
  for (const auto& timed : stats.stages)
    if (!isStart(timed.first)) sum += ownShare(stats, timed);
  return sum;
}

double lightingTime(OpenedDevice& device, const LitStage& stage, const RenderSettings& settings) {
  Stats stats;
  shadeGBuffer(device, stage.scene, stage.gbuffer, settings, stats);
  return lightingTime(stats);
}

}  // namespace luciole
