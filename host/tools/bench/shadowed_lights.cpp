#include "tools/bench/shadowed_lights.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <utility>

#include "base/random.hpp"
#include "lighting/stats.hpp"
#include "lights/light_tree.hpp"
#include "luciole/error.hpp"
#include "luciole/load_scene.hpp"
#include "reference/reference.hpp"
#include "render/render.hpp"
#include "tools/bench/light_picks.hpp"
#include "tools/bench/lit_stage.hpp"
#include "tools/bench/picture_time.hpp"
#include "tools/figures/kept_bounds.hpp"

namespace luciole {
namespace {

constexpr glm::ivec2 kShadowedSize(160, 90);
constexpr std::size_t kTracedPixels = 500;
constexpr std::uint64_t kFewestShadowed = 1000, kMostShadowed = 100'000;
constexpr int kPart = 64;  ///< an error of 1/64 …
constexpr double kConfidences[] = {0.95, 0.99};
/// Milliseconds that all timed runs of one number of lights may take together, but for the first of each row.
constexpr double kMostRoundMilliseconds = 3000;
/// Milliseconds that lights one by one may take; the time of more is estimated.
constexpr double kMostExactMilliseconds = 5000;
constexpr std::size_t kTermsAtOnce = 4'000'000;  ///< of pixels and lights: 400 MB
constexpr std::size_t kFirstPicks = 64;          ///< a pixel, to learn how long they take

const NoValue kIsTruth{"every ray is the truth"};
const NoValue kNoRays{"a beam is of many pixels"};
const NoValue kNoInterval{"it states no interval"};
const NoValue kNotSampled{"by its surfaces' model no light is sampled"};

/// A judged pixel that shows a surface.
struct JudgedPoint {
  SurfacePoint point;  ///< without emission
  Model model;
  glm::dvec3 own;    ///< what leaves it without the lights
  glm::dvec3 start;  ///< of shadow rays, world
};

/// What is lit, and by which rays it is judged.
struct ShadowedStage {
  LitStage lit;
  std::vector<JudgedPoint> points;  ///< of lit.judged, all of which show a surface
  double pixels_a_point = 0;        ///< pixels that show a surface, for each of `points`
  RayScene rays;                    ///< refers to lit.scene
  double rays_milliseconds = 0;     ///< that making `rays` took
};

/// Fills in all but `lit`.
void prepareJudgement(ShadowedStage& stage) {
  LitStage& lit = stage.lit;
  clearLights(lit.scene);
  std::vector<glm::ivec2> judged;
  for (const glm::ivec2& pixel : lit.judged) {
    const std::optional<PixelTerms> terms = referenceTerms(lit.scene, lit.gbuffer, pixel, {});
    if (!terms) continue;
    judged.push_back(pixel);
    stage.points.push_back({terms->point, terms->model, terms->own + terms->point.emission,
                            shadowStart(lit.gbuffer, lit.gbuffer.index(pixel.x, pixel.y))});
    stage.points.back().point.emission = glm::dvec3(0.0);
  }
  if (judged.empty())
    throw InputError(fmt::format("{}: too little of its picture shows anything", lit.scene.name));
  lit.judged = std::move(judged);
  const GBuffer& gbuffer = lit.gbuffer;
  const auto covered = std::count_if(gbuffer.position.begin() + std::ptrdiff_t(2 * gbuffer.pixels()),
                                     gbuffer.position.end(), [](float z) { return std::isfinite(z); });
  stage.pixels_a_point = double(covered) / double(stage.points.size());
  stage.rays_milliseconds = millisecondsOf(
      [&] { stage.rays = buildShadowRays(lit.scene, glm::dvec3(lit.gbuffer.camera.camera_to_world[3])); });
}

void placeShadowedLights(LitStage& lit, std::uint64_t count) {
  placeLights(lit, FieldShape::kBox, count);
  const std::vector<Light> lights = std::move(lit.scene.lights);
  lit.scene.lights.clear();
  // Rays to neighbours follow each other.
  for (const std::uint32_t i : spatialOrder(lights)) lit.scene.lights.push_back(lights[i]);
  for (Light& light : lit.scene.lights) light.shadow = true;
}

glm::dvec3 seenColor(const LitStage& lit, const JudgedPoint& judged, const glm::dvec3& by_lights) {
  return referenceFog(lit.scene.fog, lit.gbuffer.camera, judged.point.position, judged.own + by_lights);
}

/// Whether something is between a point and each of these lights.
std::vector<std::uint8_t> areHidden(const ShadowedStage& stage, const glm::dvec3& start,
                                    const std::vector<std::uint32_t>& lights) {
  std::vector<ShadowRay> rays;
  rays.reserve(lights.size());
  for (const std::uint32_t light : lights) rays.push_back(shadowRay(stage.lit.scene.lights[light], start));
  std::vector<std::uint8_t> hidden(rays.size());
  areBlocked(stage.rays, rays, hidden);
  return hidden;
}

/// Every light of the judged points.
struct EveryRay {
  std::vector<glm::dvec3> colors;
  std::uint64_t rays = 0;   ///< to lights that the points face
  double milliseconds = 0;  ///< of making and tracing them
};

EveryRay traceEveryRay(const ShadowedStage& stage) {
  const LitStage& lit = stage.lit;
  EveryRay every;
  const std::size_t count = stage.points.size(),
                    batch = std::max<std::size_t>(kTermsAtOnce / lit.scene.lights.size(), 1);
  for (std::size_t first = 0; first < count; first += batch) {
    const std::size_t n = std::min(batch, count - first);
    std::vector<std::vector<glm::dvec3>> terms(n);
    std::vector<std::vector<std::uint32_t>> faced(n);
    std::vector<std::vector<std::uint8_t>> hidden(n);
    tbb::parallel_for(std::size_t(0), n, [&](std::size_t i) {
      const std::optional<PixelTerms> all = referenceTerms(lit.scene, lit.gbuffer, lit.judged[first + i], {});
      for (const LightTerm& term : all->lights) {
        if (term.visibility == 0) continue;
        faced[i].push_back(std::uint32_t(term.light));
        terms[i].push_back(term.sum());
      }
    });
    every.milliseconds += millisecondsOf([&] {
      tbb::parallel_for(std::size_t(0), n, [&](std::size_t i) {
        hidden[i] = areHidden(stage, stage.points[first + i].start, faced[i]);
      });
    });
    for (std::size_t i = 0; i < n; ++i) {
      glm::dvec3 sum(0.0);
      for (std::size_t k = 0; k < terms[i].size(); ++k)
        if (!hidden[i][k]) sum += terms[i][k];
      every.colors.push_back(seenColor(lit, stage.points[first + i], sum));
      every.rays += faced[i].size();
    }
  }
  return every;
}

/// A point's colour by so many lights that are picked by the tree.
glm::dvec3 pickedColor(const ShadowedStage& stage, const PickTree& tree, const JudgedPoint& judged,
                       std::size_t picks, std::uint64_t seed) {
  struct Picked {
    std::uint32_t light;
    glm::dvec3 share;  ///< of the light's sum, if nothing hides it
  };
  std::vector<Picked> picked;
  Scene one;  // the light that was picked
  one.ambient = glm::vec3(0.0f);
  one.lights.resize(1);
  std::uint64_t state = seed << 32;
  for (std::size_t i = 0; i < picks; ++i) {
    const std::optional<LightPick> pick =
        pickLight(tree, judged.point.position, judged.point.normal, nextUniform(state));
    if (!pick) continue;
    one.lights.front() = stage.lit.scene.lights[pick->light];
    const glm::dvec3 light = referenceRadiance(one, stage.lit.gbuffer.camera, judged.point, judged.model);
    if (light != glm::dvec3(0.0))
      picked.push_back({pick->light, light / (pick->probability * double(picks))});
  }
  std::sort(picked.begin(), picked.end(), [](const Picked& a, const Picked& b) { return a.light < b.light; });
  std::vector<std::uint32_t> lights;
  for (const Picked& one_of : picked) lights.push_back(one_of.light);
  const std::vector<std::uint8_t> hidden = areHidden(stage, judged.start, lights);
  glm::dvec3 sum(0.0);
  for (std::size_t i = 0; i < picked.size(); ++i)
    if (!hidden[i]) sum += picked[i].share;
  return seenColor(stage.lit, judged, sum);
}

std::vector<glm::dvec3> pickedColors(const ShadowedStage& stage, const PickTree& tree, std::size_t picks) {
  std::vector<glm::dvec3> colors(stage.points.size());
  tbb::parallel_for(std::size_t(0), colors.size(),
                    [&](std::size_t i) { colors[i] = pickedColor(stage, tree, stage.points[i], picks, i); });
  return colors;
}

RenderSettings shadowedSettings(std::optional<double> confidence) {
  RenderSettings settings;
  settings.shade.shadows = ShadowMethod::kExact;
  if (!confidence) return settings;
  settings.shade.light_error = 1.0f / kPart;
  settings.shade.confidence = *confidence;
  settings.shade.always_clusters = true;
  settings.aovs = {Aov::kLightError};
  return settings;
}

/// The cells of true errors: root of their mean square, 99th percentile, share within the error asked for.
/// A pixel counts by the channel of the most light.
std::vector<SpeedCell> errorCells(const std::vector<glm::dvec3>& colors,
                                  const std::vector<glm::dvec3>& truth) {
  std::vector<double> errors;
  double squares = 0, within = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const int c = brightestChannel(truth[i]);
    errors.push_back(std::abs(colors[i][c] - truth[i][c]) * kPart / std::max(1.0, truth[i][c]));
    squares += errors.back() * errors.back();
    within += errors.back() <= 1;
  }
  std::sort(errors.begin(), errors.end());
  const auto n = double(errors.size());
  return {std::sqrt(squares / n), errors[errors.size() * 99 / 100], 100 * within / n};
}

/// A picture's colours at the judged pixels.
std::vector<glm::dvec3> judgedColors(const Image& picture, const LitStage& lit) {
  std::vector<glm::dvec3> colors;
  for (const glm::ivec2& pixel : lit.judged) {
    const float* color =
        picture.pixels.data() + (std::size_t(pixel.y) * picture.width + pixel.x) * picture.channels.size();
    colors.emplace_back(color[0], color[1], color[2]);
  }
  return colors;
}

/// A row that is timed in rounds: how long its picture takes (the first time: `once`), and its other cells.
struct TimedWay {
  std::string name;
  std::function<double()> milliseconds;
  double once;
  SpeedCell rays;                 ///< a pixel
  std::vector<SpeedCell> errors;  ///< errorCells(), and the share within the stated interval
};

/// Appends the rows of a stage's lights. exact: of fewer lights in the same places; becomes theirs if it is
/// measured.
void addWays(const SpeedInput& input, const ShadowedStage& stage, std::optional<ExactTime>& exact,
             SpeedTable& table) {
  const LitStage& lit = stage.lit;
  const auto lights = double(lit.scene.lights.size());
  const std::string what = fmt::format("{}: {}, {} lights", table.name, lit.scene.name, lights);
  if (input.on_progress) input.on_progress(what + ": every ray", 0, 1);
  const EveryRay every = traceEveryRay(stage);
  std::vector<TimedWay> ways;
  const auto add = [&](const std::string& name, std::optional<double> confidence) {
    const RenderSettings settings = shadowedSettings(confidence);
    Stats stats;
    const Image picture = shadeGBuffer(input.device, lit.scene, lit.gbuffer, settings, stats);
    TimedWay way{name, [&input, &lit, settings] { return lightingTime(input.device, lit, settings); },
                 lightingTime(stats), kNoRays, errorCells(judgedColors(picture, lit), every.colors)};
    way.errors.push_back(kNoInterval);
    if (confidence) {
      if (countOf(stats, "lights_sampled") == 0) return false;
      way.rays = double(countOf(stats, "sampled_rays")) / double(countOf(stats, "pixels_lit"));
      KeptBounds kept = measureBounds(picture, 0, lit.judged, every.colors);
      kept.confidence = *confidence;
      way.errors.back() = 100 * kept.held;
      if (const std::string broken = brokenPromise(kept); !broken.empty())
        table.failures.push_back(fmt::format("{}, {}: {}", what, name, broken));
    }
    ways.push_back(std::move(way));
    return true;
  };
  const bool is_exact_timed =
      !exact || exact->milliseconds * lights / exact->lights <= kMostExactMilliseconds;
  if (is_exact_timed) add("one by one", std::nullopt);
  bool is_sampled = true;
  for (const double confidence : kConfidences)
    is_sampled = is_sampled && add(fmt::format("sampled, {:g} %", 100 * confidence), confidence);
  PickTree tree;
  if (is_sampled) {
    const double tree_milliseconds = millisecondsOf([&] { tree = buildPickTree(lit.scene.lights); });
    const auto timeOf = [=, &stage, &tree](std::size_t picks) {
      return stage.rays_milliseconds + tree_milliseconds +
             stage.pixels_a_point * millisecondsOf([&] { pickedColors(stage, tree, picks); });
    };
    const double before = stage.rays_milliseconds + tree_milliseconds, first = timeOf(kFirstPicks) - before;
    const auto picks =
        std::size_t(std::max(1.0, std::round(kFirstPicks * (ways.back().once - before) / first)));
    ways.push_back({"light tree", [=] { return timeOf(picks); }, ways.back().once, double(picks),
                    errorCells(pickedColors(stage, tree, picks), every.colors)});
    ways.back().errors.push_back(kNoInterval);
  }
  const double every_milliseconds = stage.rays_milliseconds + stage.pixels_a_point * every.milliseconds;
  const auto addRow = [&](const std::string& name, std::vector<SpeedCell> cells) {
    cells.insert(cells.begin(), lights);
    cells.resize(table.columns.size(), cells.back());
    table.rows.push_back({fmt::format("{}, {}", lit.scene.name, name), std::move(cells)});
  };
  addRow("every ray", {1.0, Estimate{every_milliseconds}, Estimate{1},
                       double(every.rays) / double(stage.points.size()), kIsTruth});
  if (!is_exact_timed) {
    std::vector<SpeedCell> cells{kTooLong};
    if (exact) {
      const double time = exact->milliseconds * lights / exact->lights;
      cells = {kTooLong, Estimate{time}, Estimate{every_milliseconds / time}, kNoRays, kTooLong};
    }
    addRow("one by one", std::move(cells));
  }
  if (!is_sampled) addRow("sampled", {kNotSampled});
  if (ways.empty()) return;
  double once = 0;  // milliseconds of a round
  for (const TimedWay& way : ways) once += way.once;
  const int runs = std::clamp(int(kMostRoundMilliseconds / std::max(once, 1.0)), 1, input.repeats);
  const auto rounds = runInRounds(ways.size(), runs, what + ": times", input.on_progress,
                                  [&](std::size_t i) { return std::vector{ways[i].milliseconds()}; });
  if (is_exact_timed) exact = {lights, rounds.front().summary(0).median};
  for (std::size_t i = 0; i < ways.size(); ++i) {
    const Repeated time = rounds[i].summary(0);
    std::vector<SpeedCell> cells{double(runs), time, Estimate{every_milliseconds / time.median},
                                 ways[i].rays};
    cells.insert(cells.end(), ways[i].errors.begin(), ways[i].errors.end());
    addRow(ways[i].name, std::move(cells));
  }
}

}  // namespace

SpeedTable measureShadowedLights(const SpeedInput& input) {
  std::vector<Scene> scenes;
  if (input.scene) {
    scenes.push_back(*input.scene);
  } else {
    for (const std::string& path : shippedScenes(input.program))
      if (path.ends_with("city.json") || path.ends_with("colonnade.json")) scenes.push_back(loadScene(path));
  }
  const glm::ivec2 size = input.size.value_or(kShadowedSize);
  SpeedTable table{
      .name = kShadowedLights,
      .measured = fmt::format(
          "point lights without range in the box around what is seen, in place of the scene's own; all cast "
          "exact shadows. {} x {} pixels. Errors are from every light in double precision by Embree's rays, "
          "in "
          "parts of E = 1/{} of the larger of 1 and the colour, at {} pixels or fewer. ≈: as many times what "
          "the rays of these pixels take, or fewer lights, as there are more",
          size.x, size.y, kPart, kTracedPixels),
      .columns = {{"lights", "lights", 0},
                  {"runs", "runs", 0},
                  {"milliseconds", "ms", 0},
                  {"times_every_ray", "times faster than every ray", 1},
                  {"rays", "rays a pixel", 0},
                  {"rmse", "RMSE / E", 3},
                  {"percentile_99", "99 % of errors / E", 2},
                  {"within_error", "pixels within E, %", 1},
                  {"within_interval", "within what is stated, %", 1}}};
  for (Scene& scene : scenes) {
    clearLights(scene);
    scene.lights = {Light{.shadow = true}};  // so that the G-buffer has what shadows need
    ShadowedStage stage;
    stage.lit = setStage(std::move(scene), size, kTracedPixels);
    prepareJudgement(stage);
    std::optional<ExactTime> exact;
    for (std::uint64_t lights = kFewestShadowed; lights <= std::min(input.most_lights, kMostShadowed);
         lights *= 10) {
      placeShadowedLights(stage.lit, lights);
      addWays(input, stage, exact, table);
    }
  }
  return table;
}

}  // namespace luciole
