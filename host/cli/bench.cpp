#include <fmt/format.h>
#include <unistd.h>

#include "cli/commands.hpp"
#include "cli/picture_options.hpp"
#include "error.hpp"
#include "experiment/bench_scene.hpp"
#include "experiment/gnuplot.hpp"
#include "experiment/measure.hpp"
#include "experiment/plot.hpp"
#include "experiment/report.hpp"
#include "image/write_file.hpp"
#include "scene/load_scene.hpp"

namespace luciole {
namespace {

struct BenchOptions {
  PictureOptions picture;  ///< of which --size, --device and --quiet are options here
  std::string scene, json, plot;
  int repeats = 9;
};

/// One line that is rewritten whenever its number changes, on a terminal only.
void showProgress(const std::string& what, std::size_t percent) {
  fmt::print(stderr, "\r\x1b[K{} {} %", what, percent);
  std::fflush(stderr);
}

void bench(const BenchOptions& options) {
  if (!options.json.empty()) checkPlace(options.json);
  if (!options.plot.empty()) {
    if (!options.plot.ends_with(".svg"))
      throw InputError(fmt::format("--plot {}: expected a .svg file", options.plot));
    checkPlace(options.plot);
    requireGnuplot();
  }
  const Scene scene = options.scene.empty() ? makeBenchScene() : loadScene(options.scene);
  BenchSettings settings;
  settings.picture = renderSettings(options.picture, scene);
  settings.device = options.picture.device;
  settings.repeats = options.repeats;
  const bool progress = !options.picture.quiet && isatty(STDERR_FILENO);
  std::size_t shown = 101;
  if (progress)
    settings.on_progress = [&](const std::string& what, std::size_t done, std::size_t total) {
      const std::size_t percent = 100 * done / total;
      if (percent != shown) showProgress(what, percent);
      shown = percent;
    };
  const BenchResult result = runBench(scene, settings);
  if (progress) fmt::print(stderr, "\r\x1b[K");
  if (!options.json.empty()) writeTextFile(options.json, benchJson(result));
  if (!options.plot.empty()) writeTextFile(options.plot, benchPlot(result));
  if (options.json != "-") writeTextFile("-", benchTable(result));
}

}  // namespace

void addBenchCommand(CLI::App& app, CommandContext&) {
  CLI::App* command = app.add_subcommand("bench", "speed against error: a table with one row a variant");
  auto options = std::make_shared<BenchOptions>();
  command->add_option("SCENE", options->scene,
                      "what to draw (default: a built-in scene that uses everything)");
  command->add_option("--json", options->json,
                      "write all figures as JSON (- : standard output, without the table)");
  command->add_option("--plot", options->plot, "write speed against error as an SVG picture (by gnuplot)");
  command->add_option("--size", options->picture.size, "WxH pixels (default: the scene's, or 1280x720)");
  command->add_option("--repeats", options->repeats, "timed runs of each variant")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command->add_option("--device", options->picture.device,
                      "an index or part of a name from luciole devices, [,lanes=1|4|8|16]");
  command->add_flag("--quiet", options->picture.quiet, "no progress line");
  command->callback([options] { bench(*options); });
}

}  // namespace luciole
