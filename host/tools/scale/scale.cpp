#include "tools/scale/scale.hpp"

#include <fmt/format.h>
#include <malloc.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <new>
#include <optional>

#include "base/peak_memory.hpp"
#include "image/heat_map.hpp"
#include "lighting/stats.hpp"
#include "luciole/error.hpp"
#include "raster/visible_points.hpp"
#include "reference/reference_picture.hpp"
#include "scene/lights/light_range.hpp"
#include "tools/figures/checked_pixels.hpp"
#include "tools/figures/kept_bounds.hpp"
#include "tools/scale/scale_log.hpp"
#include "tools/scale/scale_method.hpp"

namespace luciole {
namespace {

/// Number of points that the camera sees at which lights in range are counted: enough for the mean to be
/// right to a few percent.
constexpr std::size_t kDensityPoints = 1000;

using Clock = std::chrono::steady_clock;

double millisecondsSince(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

/// The truth at the checked pixels, and what it was made with.
struct Truth {
  std::vector<Light> lights;
  Model model = Model::kPhong;
  Shading shading = Shading::kPhong;
  std::vector<glm::dvec3> colors;  ///< linear R G B of each, exposed
  Image image;                     ///< the same as channels R G B and `sampled`
};

/// What decides the lights of a point.
struct LightsKey {
  std::size_t field;
  std::uint64_t lights;
  double density;
  bool no_range;
  bool operator==(const LightsKey&) const = default;
};

/// What all points of an experiment share.
struct Bench {
  OpenedDevice& device;
  Scene& scene;
  const ScaleExperiment& experiment;
  ScaleLog& log;
  const AskForPicture& ask;
  CheckedPixels checked;
  std::vector<glm::dvec3> seen;  ///< points that the camera sees, where densities are wanted
  std::map<std::size_t, float> range_of_task;
  std::optional<LightsKey> lit_by;  ///< the lights that the scene has now
  Truth truth;  ///< the last one; points with the same lights follow each other, and share it
};

/// Replaces the scene's lights by those of the point's task.
void setLights(Bench& bench, std::size_t index) {
  const ScaleTask& task = bench.experiment.tasks[index];
  LightField field = bench.experiment.fields[task.field];
  field.count = bench.experiment.description.points[index].lights;
  const LightsKey key{task.field, field.count, task.density, task.no_range};
  if (bench.lit_by == key) return;
  bench.lit_by.reset();  // until they are there
  if (bench.experiment.truth_lights > 0) {
    setLightCounts(bench.scene, std::uint32_t(field.count));
    bench.lit_by = key;
    return;
  }
  clearLights(bench.scene);
  expandLightField(field, bench.scene);
  if (task.density > 0) {
    const auto [place, is_new] = bench.range_of_task.try_emplace(index);
    if (is_new) place->second = rangeForDensity(bench.scene.lights, bench.seen, task.density);
    for (Light& light : bench.scene.lights) light.range = place->second;
  }
  if (task.no_range) removeRanges(bench.scene.lights, bench.seen);
  bench.lit_by = key;
}

/// The picture of a point, lit by the scene's lights.
Image makePicture(const Bench& bench, const RenderSettings& settings, Stats& stats) {
  return bench.experiment.gbuffer
             ? shadeGBuffer(bench.device, bench.scene, *bench.experiment.gbuffer, settings, stats)
             : renderScene(bench.device, bench.scene, settings, stats);
}

/// The truth by the scene's lights: the last one if that fits, otherwise a new one.
const Truth& findTruth(Bench& bench, const RenderSettings& settings) {
  Truth& truth = bench.truth;
  const Scene& scene = bench.scene;
  if (!truth.image.pixels.empty() && truth.model == settings.shade.model &&
      truth.shading == settings.shading &&
      (bench.experiment.truth_lights > 0 || truth.lights == scene.lights))
    return truth;
  if (bench.experiment.truth_lights > 0) setLightCounts(bench.scene, bench.experiment.truth_lights);
  ReferenceSettings reference;
  reference.model = settings.shade.model;
  std::optional<RayScene> rays;
  if (std::any_of(scene.lights.begin(), scene.lights.end(), [](const Light& light) { return light.shadow; }))
    reference.shadow_rays =
        &rays.emplace(buildShadowRays(scene, glm::dvec3(settings.camera.camera_to_world[3])));
  truth.colors = bench.experiment.gbuffer
                     ? referencePixels(scene, *bench.experiment.gbuffer, bench.checked.pixels, reference)
                     : referencePicture(scene, cameraView(settings.camera, settings.size), settings.shading,
                                        bench.experiment.truth_samples, bench.checked.pixels, reference);
  truth.lights = scene.lights;
  truth.model = settings.shade.model;
  truth.shading = settings.shading;
  truth.image = {settings.size.x, settings.size.y, {"R", "G", "B", "sampled"}, {}};
  truth.image.pixels.assign(std::size_t(settings.size.x) * settings.size.y * 4, 0.0f);
  for (std::size_t i = 0; i < truth.colors.size(); ++i) {
    truth.colors[i] *= std::exp2(double(settings.exposure));
    const glm::ivec2& at = bench.checked.pixels[i];
    float* pixel = truth.image.pixels.data() + (std::size_t(at.y) * settings.size.x + at.x) * 4;
    for (int c = 0; c < 3; ++c) pixel[c] = pictureValue(truth.colors[i][c]);
    pixel[3] = 1;
  }
  if (bench.experiment.truth_lights > 0) setLightCounts(bench.scene, std::uint32_t(bench.lit_by->lights));
  return truth;
}

/// Gives every pixel the difference of its cell's checked pixel.
void fillCells(const CheckedPixels& checked, ImageDifference& difference) {
  const std::vector<double> sparse = difference.of_pixel;
  for (int y = 0; y < difference.height; ++y) {
    for (int x = 0; x < difference.width; ++x) {
      const glm::ivec2 cell = glm::ivec2(x, y) / checked.side;
      const glm::ivec2& at = checked.pixels[std::size_t(cell.y) * checked.cells.x + cell.x];
      difference.of_pixel[std::size_t(y) * difference.width + x] =
          sparse[std::size_t(at.y) * difference.width + at.x];
    }
  }
}

/// The picture without its layers.
Image colorsOf(const Image& picture) {
  Image colors{picture.width, picture.height, {"R", "G", "B"}, {}};
  for (std::size_t i = 0; i < picture.pixels.size(); i += picture.channels.size())
    colors.pixels.insert(colors.pixels.end(), picture.pixels.begin() + i, picture.pixels.begin() + i + 3);
  return colors;
}

std::vector<float> layerOf(const Image& picture, const std::string& name) {
  const auto channel = std::find(picture.channels.begin(), picture.channels.end(), name);
  std::vector<float> layer;
  for (std::size_t i = channel - picture.channels.begin(); i < picture.pixels.size();
       i += picture.channels.size())
    layer.push_back(picture.pixels[i]);
  return layer;
}

/// A unique file name that says what the file shows: the point's number, and its name without characters that
/// are special for file systems or shells. Without an extension, relative to the experiment's folder.
std::string fileName(const ScaleDescription& description, std::size_t index) {
  std::string name = pointName(description, description.points[index]);
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '.' && c != '-') c = '_';
  return fmt::format("{}/{:04}-{}", kPictureFolder, index + 1, name);
}

/// The largest bound of each pixel's channels.
std::vector<float> largestBounds(const Image& picture) {
  std::vector<float> largest = layerOf(picture, "light_error.R");
  for (const char* name : {"light_error.G", "light_error.B"}) {
    const std::vector<float> layer = layerOf(picture, name);
    for (std::size_t i = 0; i < layer.size(); ++i) largest[i] = std::max(largest[i], layer[i]);
  }
  return largest;
}

/// Whether the picture's bounds are of its distance from the truth: other lights err, too, and with several
/// samples the truth has others.
bool boundsTheTruth(const ScaleExperiment& experiment, const Stats& stats) {
  return stats.light_error.values > 0 && countOf(stats, "lights_exact") == 0 && experiment.truth_samples == 1;
}

/// A difference without all but kImageMetrics.
ImageDifference metricsOf(const ImageDifference& difference) {
  ImageDifference metrics;
  for (const auto& [name, figure] : kImageMetrics) metrics.*figure = difference.*figure;
  return metrics;
}

constexpr const char* kErrorMapEnding = "-error.png";

std::string writePicture(const Bench& bench, const Image& image, const std::string& file,
                         const WriteOptions& options = {}) {
  writeImage(image, bench.log.folder() + "/" + file, {{"Software", "Luciole " LUCIOLE_VERSION}}, options);
  return file;
}

/// A check of a picture's colours, which it writes, without counts.
PointCheck checkColors(Bench& bench, std::size_t index, const Image& colors) {
  ImageDifference difference =
      compareImages(findTruth(bench, bench.experiment.tasks[index].settings).image, colors);
  PointCheck check{.pixels = difference.pixels, .error = metricsOf(difference)};
  for (const Light& light : bench.scene.lights) check.reach = std::max<double>(check.reach, light.range);
  const std::string name = fileName(bench.experiment.description, index);
  check.picture = writePicture(bench, colors, name + ".png", {.dither = true});
  fillCells(bench.checked, difference);
  check.error_map = writePicture(bench, errorMap(difference), name + kErrorMapEnding);
  return check;
}

/// Has another method make a point's picture; round 0 is the one that is looked at.
AskedPicture askFor(const Bench& bench, std::size_t index, int round) {
  const ScaleDescription& description = bench.experiment.description;
  const ScalePoint& point = description.points[index];
  const RenderSettings& settings = bench.experiment.tasks[index].settings;
  return bench.ask(
      {methodOf(description, point)->name, point.lights, round, bench.scene, settings.camera, settings.size});
}

/// Compares another method's picture with the truth.
PointCheck checkOther(Bench& bench, std::size_t index) {
  setLights(bench, index);
  const ScaleTask& task = bench.experiment.tasks[index];
  const std::string file = task.other->file.empty() ? askFor(bench, index, 0).file : task.other->file;
  Image colors;
  try {
    colors = readMethodPicture(file, task.settings.size);
  } catch (const InputError& error) {
    throw NoPicture(error.what());
  }
  for (float& value : colors.pixels) value *= std::exp2(task.settings.exposure);
  return checkColors(bench, index, colors);
}

/// Another method's time; round 0 counts for nothing.
PointRun timeOther(Bench& bench, std::size_t index, int round) {
  const std::optional<OtherPicture>& other = bench.experiment.tasks[index].other;
  if (!other->file.empty()) return {.stages = {{kOtherStage, other->milliseconds.value_or(0)}}};
  setLights(bench, index);
  return {.stages = {{kOtherStage, askFor(bench, index, round).milliseconds}}};
}

/// Makes a point's picture with all counts, and compares it with the truth.
PointCheck checkPoint(Bench& bench, std::size_t index) {
  if (bench.experiment.tasks[index].other) return checkOther(bench, index);
  setLights(bench, index);
  RenderSettings settings = bench.experiment.tasks[index].settings;
  settings.count_lights = true;
  settings.aovs = {Aov::kListLength};
  if (settings.shade.light_error > 0) settings.aovs.push_back(Aov::kLightError);
  Stats stats;
  const Image picture = makePicture(bench, settings, stats);
  PointCheck check = checkColors(bench, index, colorsOf(picture));
  const std::uint64_t pixels_lit = countOf(stats, "pixels_lit");
  const std::uint64_t pairs_of_clusters =
      countOf(stats, "pixel_clusters_evaluated") + countOf(stats, "pixel_clustered_lights_evaluated");
  const std::uint64_t sampled = countOf(stats, "lights_sampled");
  // All lights that clusters stand for or that are sampled reach all pixels.
  check.pairs_evaluated =
      countOf(stats, "pixel_lights_evaluated") + pairs_of_clusters + countOf(stats, "sampled_rays");
  check.pairs_in_range =
      countOf(stats, "pixel_lights_in_range") + (countOf(stats, "lights_stood_for") + sampled) * pixels_lit;
  check.pixels_lit = pixels_lit;
  check.list_entries = countOf(stats, "list_entries");
  const std::string name = fileName(bench.experiment.description, index);
  check.list_map = writePicture(
      bench, listMap(picture.width, picture.height, layerOf(picture, "list_length")), name + "-lists.png");
  if (boundsTheTruth(bench.experiment, stats)) {
    const Truth& truth = findTruth(bench, settings);
    check.bounds = measureBounds(picture, settings.exposure, bench.checked.pixels, truth.colors);
    if (sampled > 0) check.bounds->confidence = settings.shade.confidence;
    check.bound_map = writePicture(bench, boundMap(picture.width, picture.height, largestBounds(picture)),
                                   name + "-bounds.png");
  }
  return check;
}

/// round: from 1 on; 0 counts for nothing.
PointRun timePoint(Bench& bench, std::size_t index, int round) {
  if (bench.experiment.tasks[index].other) return timeOther(bench, index, round);
  setLights(bench, index);
  malloc_trim(0);  // memory that earlier points freed shall not count for this one
  resetPeakBytes();
  Stats stats;
  makePicture(bench, bench.experiment.tasks[index].settings, stats);
  PointRun run{.stages = {}, .device_bytes = stats.device_bytes, .peak_bytes = peakBytes()};
  for (const auto& [stage, milliseconds] : stats.stages)
    if (!isStart(stage)) run.stages.emplace_back(stageName(stage), milliseconds);
  return run;
}

/// Estimates how long points will take, from those that were measured. Milliseconds.
class Estimate {
 public:
  explicit Estimate(const ScaleDescription& description) : description_(description) {}

  void measured(std::size_t point, double milliseconds) { took_[point] = milliseconds; }

  /// The time of a measured point; of another one an estimate: the last two measured points with the same
  /// values are continued with their exponent of growth, clamped to [0, 1]. Without such points it is the
  /// time of the last point measured, or 0.
  double of(std::size_t point) const {
    if (const auto known = took_.find(point); known != took_.end()) return known->second;
    const ScalePoint& wanted = description_.points[point];
    const Measured *last = nullptr, *before = nullptr;
    for (const Measured& one : took_) {
      if (description_.points[one.first].values != wanted.values) continue;
      before = last;
      last = &one;
    }
    if (!last) return took_.empty() ? 0 : took_.rbegin()->second;
    if (!before) return last->second;
    const double exponent = std::clamp(
        std::log(last->second / before->second) / std::log(lightsOf(*last) / lightsOf(*before)), 0.0, 1.0);
    return last->second * std::pow(double(wanted.lights) / lightsOf(*last), exponent);
  }

 private:
  using Measured = std::pair<const std::size_t, double>;  ///< point and milliseconds

  double lightsOf(const Measured& one) const { return double(description_.points[one.first].lights); }

  const ScaleDescription& description_;
  std::map<std::size_t, double> took_;
};

/// The checks and runs that the log lacks.
struct Work {
  std::vector<std::size_t> checks;
  std::vector<std::pair<int, std::size_t>> runs;  ///< repeat and point, in rounds
};

Work remainingWork(const ScaleDescription& description, const std::vector<std::size_t>& mine,
                   const ScaleLog& log) {
  Work work;
  const auto record = [&](std::size_t i) -> const PointRecord& {
    return log.record(pointName(description, description.points[i]));
  };
  for (const std::size_t i : mine)
    if (!record(i).check) work.checks.push_back(i);
  for (int repeat = 0; repeat < description.repeats; ++repeat) {
    for (std::size_t k = 0; k < mine.size(); ++k) {
      // Each round begins with another point, so that other work on the machine affects all points alike.
      const std::size_t i = mine[(k + std::size_t(repeat)) % mine.size()];
      if (repeat < runsOf(description, description.points[i]) && !record(i).runs.contains(repeat))
        work.runs.emplace_back(repeat, i);
    }
  }
  return work;
}

}  // namespace

std::string pointName(const ScaleDescription& description, const ScalePoint& point) {
  std::string name = fmt::format("lights={}", point.lights);
  for (std::size_t i = 0; i < point.values.size(); ++i)
    name += fmt::format(" {}={}", description.axes[i].name, point.values[i]);
  return name;
}

std::vector<std::pair<std::string, std::string>> reasonsForNull(const PointCheck& check) {
  std::vector<std::pair<std::string, std::string>> reasons;
  if (std::isinf(check.reach)) reasons.emplace_back("reach", "a light without a range reaches everywhere");
  for (const auto& [name, figure] : kImageMetrics)
    if (!std::isfinite(check.error.*figure))
      reasons.emplace_back(name,
                           check.error.max_abs == 0 ? "no checked pixel is wrong" : "a pixel is not finite");
  return reasons;
}

std::vector<ScaleFailure> runScale(OpenedDevice& device, Scene& scene, const ScaleExperiment& experiment,
                                   const std::vector<std::size_t>& mine, ScaleLog& log,
                                   const AskForPicture& ask, const OnProgress& on_progress) {
  const ScaleDescription& description = experiment.description;
  const Work work = remainingWork(description, mine, log);
  if (work.checks.empty() && work.runs.empty()) return {};
  std::filesystem::create_directories(log.folder() + "/" + kPictureFolder);
  const RenderSettings& any = experiment.tasks.front().settings;
  Bench bench{device, scene, experiment,
              log,    ask,   chooseCheckedPixels(any.size, experiment.check_pixels, experiment.seed),
              {},     {},    {},
              {}};
  if (std::any_of(experiment.tasks.begin(), experiment.tasks.end(),
                  [](const ScaleTask& task) { return task.density > 0 || task.no_range; })) {
    bench.seen = experiment.gbuffer
                     ? visiblePoints(*experiment.gbuffer, kDensityPoints, experiment.seed)
                     : visiblePoints(scene, any.camera, any.size, kDensityPoints, experiment.seed);
    if (bench.seen.empty())
      throw InputError(fmt::format("{}: its camera sees nothing, so there is no density of lights to have",
                                   description.scene));
  }

  Estimate check_time(description), run_time(description);
  const Clock::time_point start = Clock::now();
  const auto report = [&](const std::string& what, std::size_t checks_done, std::size_t runs_done) {
    if (!on_progress) return;
    double left = 0;
    for (std::size_t i = checks_done; i < work.checks.size(); ++i) left += check_time.of(work.checks[i]);
    for (std::size_t i = runs_done; i < work.runs.size(); ++i) left += run_time.of(work.runs[i].second);
    const double done = millisecondsSince(start);
    on_progress(what, std::size_t(done), std::size_t(done + left));
  };
  const auto nameOf = [&](std::size_t i) { return pointName(description, description.points[i]); };
  std::vector<ScaleFailure> failures;
  std::vector<bool> is_warm(description.points.size()), has_failed(description.points.size());
  /// The result of make() for a point. Empty, and noted as a failure, if the machine or a method fails.
  const auto tryPoint = [&](std::size_t i, auto&& make) {
    std::optional<decltype(make())> made;
    try {
      made = make();
    } catch (const NoPicture& error) {
      failures.push_back({nameOf(i), error.what(), true});
    } catch (const MachineError& error) {
      failures.push_back({nameOf(i), error.what()});
    } catch (const std::bad_alloc&) {
      failures.push_back({nameOf(i), "out of memory"});
    }
    has_failed[i] = !made;
    return made;
  };
  // A check's time is that of the picture and the truth together: half of it is taken to estimate a run's.
  for (std::size_t k = 0; k < work.checks.size(); ++k) {
    const std::size_t i = work.checks[k];
    report(fmt::format("check {} of {}: {}", k + 1, work.checks.size(), nameOf(i)), k, 0);
    const Clock::time_point began = Clock::now();
    const auto check = tryPoint(i, [&, i] { return checkPoint(bench, i); });
    if (!check) continue;
    log.append(nameOf(i), *check);
    check_time.measured(i, millisecondsSince(began));
    run_time.measured(i, millisecondsSince(began) / 2);
    is_warm[i] = true;
  }
  for (std::size_t k = 0; k < work.runs.size(); ++k) {
    const auto [repeat, i] = work.runs[k];
    report(fmt::format("run {} of {}: {}", k + 1, work.runs.size(), nameOf(i)), work.checks.size(), k);
    if (!is_warm[i] && !has_failed[i]) tryPoint(i, [&, i = i] { return timePoint(bench, i, 0); });
    is_warm[i] = true;
    if (has_failed[i]) continue;
    const Clock::time_point began = Clock::now();
    const auto run = tryPoint(i, [&, i = i, round = repeat + 1] { return timePoint(bench, i, round); });
    if (run) log.append(nameOf(i), repeat, *run);
    run_time.measured(i, millisecondsSince(began));
  }
  return failures;
}

}  // namespace luciole
