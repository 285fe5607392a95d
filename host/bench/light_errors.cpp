#include "bench/light_errors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "base/error.hpp"
#include "bench/bench.hpp"
#include "bench/speed_scenes.hpp"
#include "figures/checked_pixels.hpp"
#include "figures/kept_bounds.hpp"
#include "raster/visible_points.hpp"
#include "reference/reference.hpp"
#include "render/render.hpp"
#include "render/stats.hpp"
#include "scene/bounds.hpp"
#include "scene/lights/light_field.hpp"
#include "scene/lights/light_range.hpp"

namespace luciole {
namespace {

constexpr glm::ivec2 kBoundedSize(1280, 720);
constexpr std::size_t kJudgedPixels = 500;
constexpr std::uint64_t kFewestLights = 1000;
constexpr int kParts[] = {16, 64, 256, 1024};  ///< errors of 1/16 …
/// Milliseconds that all timed runs of one scene's rows may take together, but for the first round.
constexpr double kMostMilliseconds = 8000;
/// Pairs of a pixel and a light that are summed one by one, seconds of work; the time of more is estimated.
constexpr double kMostExactPairs = 1e10;

struct Placement {
  const char* name;
  FieldShape shape;
};
constexpr Placement kPlacements[] = {
    {"box", FieldShape::kBox}, {"clusters", FieldShape::kClusters}, {"surfaces", FieldShape::kSurface}};

/// What is lit, and where lights are put.
struct LitStage {
  Scene scene;
  GBuffer gbuffer;
  std::vector<glm::dvec3> seen;  ///< points that the camera sees
  std::vector<glm::ivec2> judged;
};

Scene makeMatteHall() {
  Scene hall = makeHall();
  for (Material& material : hall.materials) material.specular = glm::vec3(0.0f);
  return hall;
}

LitStage setStage(Scene scene, glm::ivec2 size) {
  LitStage stage{std::move(scene), {}, {}, chooseCheckedPixels(size, kJudgedPixels, 0).pixels};
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
  stage.scene.lights.clear();
  expandLightField(field, stage.scene);
  spreadEverywhere(stage.scene.lights, stage.seen);
}

RenderSettings settingsFor(float light_error) {
  RenderSettings settings;
  settings.shade.shadows = ShadowMethod::kOff;
  settings.shade.light_error = light_error;
  return settings;
}

/// Milliseconds of all that lighting the G-buffer takes, the tree of lights included.
double lightingTime(Device& device, const LitStage& stage, float light_error) {
  Stats stats;
  shadeGBuffer(device, stage.scene, stage.gbuffer, settingsFor(light_error), stats);
  double sum = 0;
  for (const auto& timed : stats.stages)
    if (!isStart(timed.first)) sum += ownShare(stats, timed);
  return sum;
}

/// How the picture with this error keeps its bounds; nothing where no light is stood for.
std::optional<KeptBounds> judge(Device& device, const LitStage& stage, const std::vector<glm::dvec3>& truth,
                                float light_error) {
  RenderSettings settings = settingsFor(light_error);
  settings.aovs = {Aov::kLightError};
  Stats stats;
  const Image picture = shadeGBuffer(device, stage.scene, stage.gbuffer, settings, stats);
  if (stats.light_error.values == 0) return std::nullopt;
  return judgeBounds(picture, settings.exposure, stage.judged, truth);
}

std::vector<SpeedCell> boundCells(const std::optional<KeptBounds>& kept) {
  if (!kept) return std::vector<SpeedCell>(7, NoValue{"clusters stand for no light"});
  return {kept->max_bound * k8BitSteps,
          kept->mean_bound * k8BitSteps,
          kept->max_error * k8BitSteps,
          kept->mean_error * k8BitSteps,
          kept->max_used,
          kept->mean_used,
          double(kept->violations)};
}

/// The time of all lights one by one, by the most of a placement's that were measured.
struct ExactTime {
  double lights = 0, milliseconds = 0;
};

/// Appends the rows of a stage's lights. exact: of fewer lights in the same places; becomes theirs if it is
/// measured.
void addRows(const SpeedInput& input, const LitStage& stage, const std::string& placement,
             std::optional<ExactTime>& exact, SpeedTable& table) {
  const auto lights = double(stage.scene.lights.size());
  const std::string what = fmt::format("{}: {} lights, {}", table.name, lights, placement);
  const auto report = [&](std::size_t done) {
    if (input.on_progress) input.on_progress(what + ": the truth", done, 1 + std::size(kParts));
  };
  std::vector<float> errors;
  for (const int parts : kParts) errors.push_back(1.0f / float(parts));
  const std::size_t first = table.rows.size();
  report(0);
  const std::vector<glm::dvec3> truth = referencePixels(stage.scene, stage.gbuffer, stage.judged, {});
  double once = 0;  // milliseconds of a round
  for (std::size_t i = 0; i < errors.size(); ++i) {
    report(1 + i);
    once += millisecondsOf([&] {  // compiles, too
      const std::optional<KeptBounds> kept = judge(input.device, stage, truth, errors[i]);
      std::vector<SpeedCell> cells{lights, {}, {}, {}, {}};
      for (const SpeedCell& cell : boundCells(kept)) cells.push_back(cell);
      table.rows.push_back({fmt::format("{}, 1/{}", placement, kParts[i]), cells});
      if (kept && kept->violations > 0)
        table.failures.push_back(
            fmt::format("{}: {} lights, {}: {} of {} values are wrong by more than "
                        "their bounds",
                        table.name, lights, table.rows.back().name, kept->violations, kept->values));
    });
  }
  const double pixels = double(stage.gbuffer.picture_size.x) * stage.gbuffer.picture_size.y;
  const bool is_exact_timed = lights * pixels <= kMostExactPairs;
  if (is_exact_timed) {
    errors.push_back(0);
    once += lightingTime(input.device, stage, 0);
  }
  const int rounds_affordable = int(std::clamp(kMostMilliseconds / once, 1.0, double(input.repeats)));
  const auto rounds = runInRounds(
      errors.size(), rounds_affordable, what, input.on_progress,
      [&](std::size_t row) { return std::vector{lightingTime(input.device, stage, errors[row])}; });
  if (is_exact_timed) exact = {lights, rounds.back().summary(0).median};
  for (std::size_t i = 0; i < std::size(kParts); ++i) {
    const Repeated time = rounds[i].summary(0);
    std::vector<SpeedCell>& cells = table.rows[first + i].cells;
    cells[1] = double(rounds_affordable);
    cells[2] = time;
    if (is_exact_timed) {
      cells[3] = rounds.back().summary(0);
      cells[4] = ratio(rounds.back().figures[0], rounds[i].figures[0]);
    } else if (exact) {
      const double estimate = exact->milliseconds * lights / exact->lights;
      cells[3] = Estimate{estimate};
      cells[4] = Estimate{estimate / time.median};
    } else {
      cells[3] = cells[4] = NoValue{"even the fewest lights would take too long one by one"};
    }
  }
}

}  // namespace

SpeedTable measureLightErrors(const SpeedInput& input) {
  LitStage stage = setStage(input.scene ? *input.scene : makeMatteHall(), input.size.value_or(kBoundedSize));
  const glm::ivec2 size = stage.gbuffer.picture_size;
  SpeedTable table{
      .name = kLightErrors,
      .measured = fmt::format(
          "{}{}, lit by point lights without range in place of its own, {} x {} pixels; bounds and errors "
          "are "
          "in 8-bit steps of the larger of 1 and the colour; errors are from all lights in double precision, "
          "at {} pixels; ≈: as many times what fewer lights take as there are more",
          stage.scene.name, input.scene ? "" : " with matte surfaces", size.x, size.y, stage.judged.size()),
      .columns = {{"lights", "lights", 0},
                  {"runs", "runs", 0},
                  {"milliseconds", "ms", 1},
                  {"exact_milliseconds", "one by one, ms", 0},
                  {"times_faster", "times faster", 1},
                  {"max_bound_steps", "largest bound", 3},
                  {"mean_bound_steps", "mean bound", 4},
                  {"max_error_steps", "largest error", 3},
                  {"mean_error_steps", "mean error", 4},
                  {"max_used", "error / bound, largest", 3},
                  {"mean_used", "mean", 3},
                  {"violations", "bounds broken", 0}}};
  for (const Placement& placement : kPlacements) {
    std::optional<ExactTime> exact;
    for (std::uint64_t lights = kFewestLights; lights <= input.most_lights; lights *= 10) {
      placeLights(stage, placement.shape, lights);
      addRows(input, stage, placement.name, exact, table);
    }
  }
  return table;
}

}  // namespace luciole
