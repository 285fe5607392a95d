#include <fmt/format.h>

#include <algorithm>
#include <csignal>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/write_file.hpp"
#include "load/no_light_warning.hpp"
#include "luciole/error.hpp"
#include "luciole/gbuffer_file.hpp"
#include "tools/cli/commands.hpp"
#include "tools/cli/event_log.hpp"
#include "tools/cli/picture_options.hpp"
#include "tools/cli/progress.hpp"
#include "tools/cli/scale_against.hpp"
#include "tools/cli/scale_plan.hpp"
#include "tools/cli/shard.hpp"
#include "tools/devices/check_device.hpp"
#include "tools/scale/page.hpp"
#include "tools/scale/scale.hpp"
#include "tools/scale/scale_files.hpp"
#include "tools/scale/scale_log.hpp"
#include "tools/scale/scale_plot.hpp"
#include "tools/scale/scale_table.hpp"

namespace luciole {
namespace {

struct MergeOptions {
  std::vector<std::string> folders;
  std::string output, plot;
  bool mixes_devices = false;
};

/// Throws before any work what writing the page and the plot would throw.
void checkDrawing(const std::string& plot) {
  requireChartLibrary();
  if (plot.empty()) return;
  if (!plot.ends_with(".svg")) throw InputError(fmt::format("--plot {}: expected a .svg file", plot));
  checkPlace(plot);
}

/// The points named in one line: ten at most, then how many more.
std::string listPoints(const std::vector<std::string>& names) {
  constexpr std::size_t kMost = 10;
  const std::size_t shown = std::min(names.size(), kMost);
  std::string list = fmt::format("{}", fmt::join(names.begin(), names.begin() + std::ptrdiff_t(shown), "; "));
  if (shown < names.size()) list += fmt::format("; and {} more", names.size() - shown);
  return list;
}

/// Writes all files that are made from a log. Returns the exit status. is_all: of all shards together, so
/// that no point may be missing. prints_table: on standard output.
int writeResults(const ScaleResults& results, const std::string& folder, const std::string& plot,
                 const std::string& command_line, bool quiet, bool prints_table, bool is_all) {
  const ScaleSummary summary = summarizeScale(results);
  writeTextFile(folder + "/results.csv", scaleCsv(summary));
  writeTextFile(folder + "/growth.json", growthJson(summary));
  writeTextFile(folder + "/report.html", experimentPage(pageData(summary, folder, command_line)));
  const bool has_own = std::any_of(summary.points.begin(), summary.points.end(),
                                   [](const PointSummary& point) { return point.is_own; });
  if (!plot.empty() && has_own) writeTextFile(plot, scalePlot(summary));
  if (prints_table) fmt::print("{}", scaleTable(summary));
  const bool is_lacking = is_all && !summary.incomplete.empty();
  if (is_lacking)
    reportError(fmt::format("{}: {} of {} points are not complete: {}", folder, summary.incomplete.size(),
                            summary.description.points.size(), listPoints(summary.incomplete)),
                kDifferent);
  else if (!summary.incomplete.empty() && !quiet)
    fmt::print(stderr, "{}: {} of {} points are done; luciole scale merge joins the shards'\n", folder,
               summary.description.points.size() - summary.incomplete.size(),
               summary.description.points.size());
  for (const std::string& violation : summary.violations) reportError(violation, kDifferent);
  return summary.violations.empty() && !is_lacking ? kDone : kDifferent;
}

/// Returns the exit status.
int scale(CLI::App& command, ScaleOptions& options, const std::string& command_line) {
  checkScaleOptions(command, options);
  const Shard shard = chosenShard(options.shard);
  checkDrawing(options.plot);
  if (options.shard.empty() && shard.count > 1 && !options.picture.quiet)
    writeError(
        fmt::format("shard {}/{} of the points, as task of a Slurm array\n", shard.index + 1, shard.count));
  options.frame = useFrame(options.picture, "scale");
  std::optional<GBuffer> gbuffer;
  if (!options.gbuffer.empty()) gbuffer = readGBuffer(options.gbuffer);
  Scene scene;
  if (!options.scene.empty())
    scene = loadScene(options.scene, options.frame, options.picture.load);
  else
    scene.cameras = {gbuffer->camera};
  takeModel(options.picture, scene);
  std::erase(scene.warnings, noLightWarning(scene));
  if (!options.picture.quiet) reportWarnings(scene.warnings);
  ScaleExperiment experiment = planExperiment(command, options, scene, std::move(gbuffer));
  if (experiment.too_exact > 0 && !options.picture.quiet)
    writeError(fmt::format(
        "points with a light error of 0 that are left out, as so many lights one by one take long: {}\n",
        experiment.too_exact));
  if (!options.picture.quiet)
    for (const std::string& line : experiment.missing) writeError("luciole: against " + line + "\n");
  std::optional<PictureQuestions> questions;
  if (asksForPictures(experiment)) {
    if (!options.picture.load.changes.empty())
      throw InputError("scale: --set: not with --against NAME=-, whose scenes are made from the file");
    std::signal(SIGPIPE, SIG_IGN);  // who no longer listens is told of as an error
    questions.emplace(options.scene, options.gbuffer, options.frame);
  }
  OpenedDevice device;
  openDevice(options.picture.device, device);
  device.description.arithmetic = knownArithmetic(device).sha256;
  ScaleLog log(options.output, experiment.description);
  log.append(describeMachine(device));
  std::vector<std::size_t> mine;
  for (std::size_t i = 0; i < experiment.tasks.size(); ++i)
    if (isMine(shard, i)) mine.push_back(i);
  ProgressLine progress(options.picture.quiet);
  const std::vector<ScaleFailure> failures = runScale(
      device, scene, experiment, mine, log,
      [&](const PictureRequest& request) { return questions->ask(request); },
      [&](const std::string& what, std::size_t done, std::size_t total) {
        progress.show(what, done, total);
      });
  progress.clear();
  for (const ScaleFailure& failure : failures)
    writeError(fmt::format("luciole: {}: {}\n", failure.point, failure.reason));
  const bool quiet = options.picture.quiet;
  const int status = writeResults(log.results(), options.output, options.plot, command_line, quiet,
                                  !quiet && !questions, false);
  return std::all_of(failures.begin(), failures.end(),
                     [](const ScaleFailure& failure) { return failure.is_of_method; })
             ? status
             : kMachineFailed;
}

}  // namespace

void addScaleCommand(CLI::App& app, CommandContext& context) {
  CLI::App* command = app.add_subcommand(
      "scale", "many-light experiments: time and error against the number of lights, as data and a page");
  auto options = std::make_shared<ScaleOptions>();
  options->picture.settings["shadows"] = "off";
  command->add_option("SCENE", options->scene,
                      "a .json, .obj, .gltf or .glb file; its own lights are left out unless --own-lights");
  command->add_option(
      "--gbuffer", options->gbuffer,
      "an EXR whose surfaces to light instead; of SCENE, if there is one, then count ambient, "
      "fog and shadow casters");
  command->add_option("--lights", options->lights, "numbers of lights: 1,10,100 or 1,10,...,1000000");
  command
      ->add_option("--vary", options->vary,
                   "options to try in every combination: culling,tile=4,8 (without values: some that make "
                   "sense); repeatable")
      ->allow_extra_args(false);
  command
      ->add_option(
          "--against", options->against,
          "another method's pictures, linear and before exposure, held against the same truth: "
          "NAME=FILE with {lights} for the number of lights, and after it ,ms=MILLISECONDS or "
          "ms=FILE.csv with lines lights,milliseconds; or NAME=- to be asked for them, a line of JSON "
          "on standard output and one on standard input for each; repeatable")
      ->allow_extra_args(false)
      ->type_name("NAME=PICTURES");
  command->add_option("--repeat", options->repeats, "timed runs of each point")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command
      ->add_option("-o,--output", options->output,
                   "folder for results and report.html; what it holds of this experiment isn't done again")
      ->type_name("FOLDER");
  command->add_option("--plot", options->plot, "also write time against lights as an SVG picture");
  command
      ->add_option("--check-pixels", options->check_pixels,
                   "about how many pixels are held against the reference")
      ->check(CLI::Range(1, 1 << 30))
      ->capture_default_str();
  command->add_option("--seed", options->seed, "of the lights and the checked pixels")->capture_default_str();
  command
      ->add_option("--field", options->field,
                   "where lights are: " + std::string(kFieldShapeNames) +
                       ", or a .csv file: its first lights, with their own colours, and ranges unless others "
                       "are asked for")
      ->capture_default_str();
  const CLI::Range positive(1e-18, 1e18);
  auto* density = command
                      ->add_option("--density", options->density,
                                   "lights in range of a visible pixel on average: the more there are, the "
                                   "less far each reaches")
                      ->check(positive)
                      ->capture_default_str();
  auto* range = command->add_option("--range", options->range, "or: metres that all lights reach")
                    ->check(positive)
                    ->excludes(density);
  auto* cutoff =
      command
          ->add_option(
              "--cutoff", options->cutoff,
              "or: lights fade with the square of the distance, and reach to where they have faded to this")
          ->check(positive)
          ->excludes(density)
          ->excludes(range);
  command
      ->add_flag(
          "--no-range", options->no_range,
          "or: lights reach everywhere, faded with the square of the distance; as bright on average as with "
          "a density of 8 (default with --light-error)")
      ->excludes(density)
      ->excludes(range)
      ->excludes(cutoff);
  auto* no_range = command->get_option("--no-range");
  auto* intensity = command->add_option("--intensity", options->intensity, "of each light")
                        ->check(CLI::Range(0.0, 1e18))
                        ->capture_default_str();
  command
      ->add_flag("--sources", options->sources,
                 "so many lights for each of SCENE's environments, faces and glowing meshes, beside its own "
                 "lights; errors are from 16 times the largest number of them")
      ->excludes(density)
      ->excludes(range)
      ->excludes(cutoff)
      ->excludes(no_range)
      ->excludes(intensity);
  command
      ->add_flag(
          "--own-lights", options->own_lights,
          "the first of SCENE's own lights, or of --field's .csv file, as they are: brightness, ranges, "
          "attenuation, spots")
      ->excludes(density)
      ->excludes(range)
      ->excludes(cutoff)
      ->excludes(no_range)
      ->excludes(intensity);
  command->add_option("--shard", options->shard,
                      "I/N: only every N-th point from the I-th on (default: the task of a Slurm array)");
  addPictureOptions(*command, options->picture,
                    kViewOptions | kSampleOption | kModelOptions | kShadeOptions | kDeviceOption |
                        kManyPictures | kFrameOption);
  command->get_option("--frames")->description("which frame of a scene that moves (default: 1)");
  command->get_option("--size")->description("WxH pixels, or W (default: 640x360)");

  CLI::App* merge = command->add_subcommand("merge", "put the results of shards together");
  auto merging = std::make_shared<MergeOptions>();
  merge->add_option("FOLDER", merging->folders, "the shards' folders")->required();
  merge->add_option("-o,--output", merging->output, "a new folder")->required()->type_name("FOLDER");
  merge->add_option("--plot", merging->plot, "as for scale");
  merge->add_flag(
      "--mix-devices", merging->mixes_devices,
      "also merge folders of devices whose arithmetic differs, so that pictures of the same point "
      "would");
  merge->callback([&context, merging] {
    checkDrawing(merging->plot);
    context.status = writeResults(mergeScaleLogs(merging->folders, merging->output, merging->mixes_devices),
                                  merging->output, merging->plot, context.command_line, false, true, true);
  });
  command->callback([&context, command, merge, options] {
    if (!merge->parsed()) context.status = scale(*command, *options, context.command_line);
  });
}

}  // namespace luciole
