#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>

#include "base/write_file.hpp"
#include "luciole/error.hpp"
#include "luciole/gbuffer_file.hpp"
#include "shadow/maps/shadow_sizes.hpp"
#include "tools/bench/bench.hpp"
#include "tools/bench/bench_scene.hpp"
#include "tools/bench/light_errors.hpp"
#include "tools/bench/plot.hpp"
#include "tools/bench/report.hpp"
#include "tools/cli/commands.hpp"
#include "tools/cli/picture_options.hpp"
#include "tools/cli/progress.hpp"
#include "tools/cli/suggest.hpp"

namespace luciole {
namespace {

struct BenchOptions {
  PictureOptions picture;  ///< of which --model, --size, --device and --quiet are options here
  std::string scene, gbuffer, lights, json, plot;
  std::vector<std::string> only;
  std::optional<int> shadow_size;
  int repeats = 9;
};

bool isPlotted(const std::string& name) {
  return name == "shading" || name == "shadows" || name == "samples" || name == kLightErrors;
}

std::string joinedNames() { return fmt::format("{}", fmt::join(benchNames(), ", ")); }

/// Returns the exit status.
int bench(const BenchOptions& options) {
  if (!options.json.empty()) checkPlace(options.json);
  if (!options.plot.empty()) {
    if (!options.plot.ends_with(".svg"))
      throw InputError(fmt::format("--plot {}: expected a .svg file", options.plot));
    if (!options.only.empty() && std::none_of(options.only.begin(), options.only.end(), isPlotted))
      throw InputError(
          fmt::format("--plot {}: shows shading, shadows, samples and {}, of which --only names none",
                      options.plot, kLightErrors));
    checkPlace(options.plot);
  }
  constexpr const char* kCullAndShade = "cull and shade";
  if (!options.gbuffer.empty() && !options.only.empty() &&
      std::find(options.only.begin(), options.only.end(), kCullAndShade) == options.only.end())
    throw InputError(
        fmt::format("--gbuffer {}: is for \"{}\", which --only leaves out", options.gbuffer, kCullAndShade));
  const Scene scene = options.scene.empty() ? makeBenchScene() : openScene(options.scene, 1, options.picture);
  BenchSettings settings;
  settings.picture = renderSettings(options.picture, scene);
  settings.device = options.picture.device;
  settings.repeats = options.repeats;
  std::optional<ProgressLine> progress;
  std::string shown;
  settings.on_progress = [&](const std::string& what, std::size_t done, std::size_t total) {
    if (!progress || what != shown) progress.emplace(options.picture.quiet);
    progress->show(shown = what, done, total);
  };
  BenchChoice choice{.only = options.only,
                     .named_scene = !options.scene.empty(),
                     .program = std::filesystem::read_symlink("/proc/self/exe")};
  choice.scene_path = options.scene;
  choice.picture_options = typedLoadOptions(options.picture.load);
  if (!options.picture.value("cast_shadows").empty())
    for (const std::string& word : {std::string("--cast-shadows"), options.picture.value("cast_shadows")})
      choice.picture_options.push_back(word);
  if (!options.picture.value("size").empty()) choice.size = settings.picture.size;
  choice.shadow_size = options.shadow_size;
  if (!options.gbuffer.empty()) {
    Scene lights = openScene(options.lights, 1, options.picture);
    const Model model = modelOf(options.picture, lights);
    choice.given = {options.gbuffer, readGBuffer(options.gbuffer), std::move(lights), model};
    if (choice.only.empty()) choice.only = {kCullAndShade};
  }
  const BenchResult result = runBench(scene, settings, choice);
  if (progress) progress->clear();
  if (!options.json.empty()) writeTextFile(options.json, benchJson(result));
  if (!options.plot.empty()) writeTextFile(options.plot, benchPlot(result));
  if (options.json != "-") writeTextFile("-", benchTable(result));
  int status = kDone;
  for (const SpeedTable& table : result.speed) {
    for (const std::string& failure : table.failures) {
      status = kDifferent;
      reportError(failure, status);
    }
  }
  return status;
}

}  // namespace

void addBenchCommand(CLI::App& app, CommandContext& context) {
  CLI::App* command = app.add_subcommand(
      "bench", "what everything costs: speed against error, and each stage's speed, in tables");
  auto options = std::make_shared<BenchOptions>();
  command->add_option("SCENE", options->scene,
                      "what speed against error, the rasterizer and picture draw (default: built-in scenes, "
                      "and for picture the six that come with the program)");
  CLI::Option* gbuffer = command->add_option(
      "--gbuffer", options->gbuffer,
      "an EXR file of a G-buffer: times culling and shading alone on it (--only \"cull and shade\")");
  CLI::Option* lights =
      command->add_option("--scene", options->lights, "the scene whose lights light the G-buffer");
  gbuffer->needs(lights);
  lights->needs(gbuffer);
  addModelOption(*command, options->picture)->needs(gbuffer);
  command->add_option("--only", options->only, "measure this alone (repeatable): " + joinedNames())
      ->check(oneOf(benchNames()));
  command->add_option("--json", options->json,
                      "write all figures as JSON (- : standard output, without the table)");
  command->add_option("--plot", options->plot, "write speed against error as an SVG picture");
  command->add_option("--size", options->picture.settings["size"],
                      "WxH pixels of every picture, or W (default: each one's own)");
  command
      ->add_option("--shadow-size", options->shadow_size,
                   "texels a side of shadow maps, as for render (default: several are tried)")
      ->check(CLI::Range(kSmallestFace, kLargestFace));
  command->add_option("--repeats", options->repeats, "timed runs of each row")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command->add_option("--device", options->picture.device,
                      "an index or part of a name from luciole devices, [,lanes=1|4|8|16]");
  addSetting(*command, options->picture, "cast_shadows");
  addLoadOptions(*command, options->picture.load);
  addThreadsOption(*command);
  command->add_flag("--quiet", options->picture.quiet, "no progress line");
  command->callback([&context, options] { context.status = bench(*options); });
}

}  // namespace luciole
