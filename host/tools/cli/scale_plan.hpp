#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "tools/cli/picture_options.hpp"
#include "tools/scale/scale.hpp"

namespace luciole {

/// The options of luciole scale, as typed.
struct ScaleOptions {
  PictureOptions picture;
  std::string scene, gbuffer, output, plot, lights, shard, field = "box";
  std::vector<std::string> vary, against;
  double density = 8;
  std::optional<double> range, cutoff;
  bool no_range = false, own_lights = false, sources = false;
  int frame = 1;
  double intensity = 1;
  int repeats = 5;
  std::size_t check_pixels = 1024;
  std::uint64_t seed = 0;
};

/// Throws InputError if options of `command` are missing or contradict each other.
void checkScaleOptions(const CLI::App& command, const ScaleOptions& options);

/// The experiment that the options mean for this scene, or for a G-buffer's surfaces in place of its own.
/// Each variant's values are set through the command's options, so that the same checks apply to them;
/// afterwards `options` holds those of the last variant. Throws InputError.
ScaleExperiment planExperiment(CLI::App& command, ScaleOptions& options, const Scene& scene,
                               std::optional<GBuffer> gbuffer);

}  // namespace luciole
