#include "tools/bench/light_errors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "reference/reference.hpp"
#include "render/render.hpp"
#include "shade/features.hpp"
#include "tools/bench/bench.hpp"
#include "tools/bench/lit_stage.hpp"
#include "tools/bench/speed_scenes.hpp"
#include "tools/figures/kept_bounds.hpp"

namespace luciole {
namespace {

constexpr glm::ivec2 kBoundedSize(1280, 720);
constexpr std::size_t kJudgedPixels = 1000;
constexpr std::uint64_t kFewestLights = 1000;
constexpr int kParts[] = {16, 64, 256, 1024};  ///< errors of 1/16 …
/// Milliseconds that all timed runs of one scene's rows may take together, but for the first rounds.
constexpr double kMostMilliseconds = 8000;
constexpr double kFewestRounds = 3;
/// Pairs of a pixel and a light that are summed one by one, seconds of work; the time of more is estimated.
constexpr double kMostExactPairs = 1e10;

constexpr std::size_t kBoundColumns = 7;  ///< the last of the table

struct Placement {
  const char* name;
  FieldShape shape;
};
constexpr Placement kPlacements[] = {
    {"box", FieldShape::kBox}, {"clusters", FieldShape::kClusters}, {"surfaces", FieldShape::kSurface}};

Scene makeMatteHall() {
  Scene hall = makeHall();
  for (Material& material : hall.materials) material.specular = glm::vec3(0.0f);
  return hall;
}

RenderSettings settingsFor(float light_error) {
  RenderSettings settings;
  settings.shade.shadows = ShadowMethod::kOff;
  settings.shade.light_error = light_error;
  settings.shade.always_clusters = true;
  return settings;
}

/// Whether lighting is too much work to be measured, because it sums too many lights one by one.
bool takesTooLong(const LitStage& stage, float light_error) {
  const GBuffer& gbuffer = stage.gbuffer;
  const SurfaceTraits surfaces{!gbuffer.specular.empty(), !gbuffer.emission.empty(), false};
  const double pixels = double(gbuffer.picture_size.x) * gbuffer.picture_size.y;
  return double(stage.scene.lights.size()) * pixels > kMostExactPairs &&
         !standIns(stage.scene, cameraView(gbuffer.camera, gbuffer.picture_size), surfaces,
                   settingsFor(light_error).shade)
              .clustered;
}

/// How the picture with this error keeps its bounds; nothing where no light is stood for.
std::optional<KeptBounds> judge(OpenedDevice& device, const LitStage& stage,
                                const std::vector<glm::dvec3>& truth, float light_error) {
  RenderSettings settings = settingsFor(light_error);
  settings.aovs = {Aov::kLightError};
  Stats stats;
  const Image picture = shadeGBuffer(device, stage.scene, stage.gbuffer, settings, stats);
  if (stats.light_error.values == 0) return std::nullopt;
  return measureBounds(picture, settings.exposure, stage.judged, truth);
}

std::vector<SpeedCell> boundCells(const std::optional<KeptBounds>& kept) {
  if (!kept) return std::vector<SpeedCell>(kBoundColumns, NoValue{"clusters stand for no light"});
  return {kept->max_bound * k8BitSteps,
          kept->mean_bound * k8BitSteps,
          kept->max_error * k8BitSteps,
          kept->mean_error * k8BitSteps,
          kept->max_used,
          kept->mean_used,
          double(kept->violations)};
}

/// What is timed: a row of the table, or the lights one by one.
struct TimedLighting {
  float light_error = 0;
  std::optional<std::size_t> row{};
};

/// Appends the rows of a stage's lights, without times, and returns those that don't take too long.
std::vector<TimedLighting> addBounds(const SpeedInput& input, const LitStage& stage,
                                     const std::string& placement, SpeedTable& table) {
  const std::uint64_t lights = stage.scene.lights.size();
  const std::string what = fmt::format("{}: {} lights, {}: bounds", table.name, lights, placement);
  const auto report = [&](std::size_t done) {
    if (input.on_progress) input.on_progress(what, done, std::size(kParts));
  };
  std::vector<glm::dvec3> truth;  // once it is needed
  std::vector<TimedLighting> timed;
  for (std::size_t i = 0; i < std::size(kParts); ++i) {
    report(i);
    SpeedRow row{fmt::format("{}, 1/{}", placement, kParts[i]), {double(lights)}};
    const float light_error = 1.0f / float(kParts[i]);
    if (takesTooLong(stage, light_error)) {
      row.cells.resize(table.columns.size(), kTooLong);
    } else {
      if (truth.empty()) truth = referencePixels(stage.scene, stage.gbuffer, stage.judged, {});
      const std::optional<KeptBounds> kept = judge(input.device, stage, truth, light_error);
      row.cells.resize(table.columns.size() - kBoundColumns);
      for (const SpeedCell& cell : boundCells(kept)) row.cells.push_back(cell);
      if (kept && kept->violations > 0)
        table.failures.push_back(
            fmt::format("{}: {} lights, {}: {} of {} values are wrong by more than their bounds", table.name,
                        lights, row.name, kept->violations, kept->values));
      timed.push_back({light_error, table.rows.size()});
    }
    table.rows.push_back(row);
  }
  return timed;
}

/// Times the rows of a stage's lights. exact: of fewer lights in the same places; becomes theirs if it is
/// measured.
void addTimes(const SpeedInput& input, const LitStage& stage, std::vector<TimedLighting> timed,
              std::optional<ExactTime>& exact, SpeedTable& table) {
  const auto lights = double(stage.scene.lights.size());
  const bool is_exact_timed = !takesTooLong(stage, 0);
  if (is_exact_timed) timed.push_back({});
  if (timed.empty()) return;
  double once = 0;  // milliseconds of a round, which isn't counted: it makes memory and caches warm
  for (const TimedLighting& one : timed)
    once += lightingTime(input.device, stage, settingsFor(one.light_error));
  const int runs = std::min(input.repeats, int(std::max(kFewestRounds, kMostMilliseconds / once)));
  const auto rounds =
      runInRounds(timed.size(), runs, table.name + ": times", input.on_progress, [&](std::size_t i) {
        return std::vector{lightingTime(input.device, stage, settingsFor(timed[i].light_error))};
      });
  if (is_exact_timed) exact = {lights, rounds.back().summary(0).median};
  for (std::size_t i = 0; i < timed.size(); ++i) {
    if (!timed[i].row) continue;
    const Repeated time = rounds[i].summary(0);
    SpeedCell one_by_one = kTooLong, times_faster = kTooLong;
    if (is_exact_timed) {
      one_by_one = rounds.back().summary(0);
      times_faster = ratio(rounds.back().figures[0], rounds[i].figures[0]);
    } else if (exact) {
      const double estimate = exact->milliseconds * lights / exact->lights;
      one_by_one = Estimate{estimate};
      times_faster = Estimate{estimate / time.median};
    }
    const SpeedCell cells[] = {double(runs), time, one_by_one, times_faster};
    std::copy(std::begin(cells), std::end(cells), table.rows[*timed[i].row].cells.begin() + 1);
  }
}

}  // namespace

SpeedTable measureLightErrors(const SpeedInput& input) {
  LitStage stage = setStage(input.scene ? *input.scene : makeMatteHall(), input.size.value_or(kBoundedSize),
                            kJudgedPixels);
  const glm::ivec2 size = stage.gbuffer.picture_size;
  SpeedTable table{
      .name = kLightErrors,
      .measured = fmt::format(
          "{}{}, lit by point lights without range in place of its own, {} x {} pixels; bounds and errors "
          "in 8-bit steps of the larger of 1 and the colour; errors are from all lights in double precision "
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
      addTimes(input, stage, addBounds(input, stage, placement.name, table), exact, table);
    }
  }
  return table;
}

}  // namespace luciole
