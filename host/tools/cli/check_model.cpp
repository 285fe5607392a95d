#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "base/write_file.hpp"
#include "luciole/error.hpp"
#include "scene/models.hpp"
#include "tools/cli/commands.hpp"
#include "tools/cli/suggest.hpp"
#include "tools/models/check_model.hpp"

namespace luciole {
namespace {

struct CheckOptions {
  std::string model, device, json, plot;
  bool probe_only = false;
};

CheckedModel modelNamed(const std::string& name) {
  if (name.ends_with(kShaderExtension)) return {name, {}, readShader(name, ShaderKind::kModel)};
  for (const Model model : kAllModels)
    if (name == modelName(model)) return {name, model, {}};
  throw InputError(fmt::format("{}: no such model; expected {}, or a file *{}", name,
                               fmt::join(kModelNames, ", "), kShaderExtension));
}

}  // namespace

void addCheckModelCommand(CLI::App& app, CommandContext& context) {
  CLI::App* command = app.add_subcommand("check-model",
                                         "a shading model's bits, faults, error, energy, reciprocity and "
                                         "time; exit status 1 if a promise is broken");
  auto options = std::make_shared<CheckOptions>();
  command->add_option("MODEL", options->model, "a file of one's own, *.clh, or a built-in model's name")
      ->required();
  command->add_option("--json", options->json,
                      "also write all figures as JSON (- : on standard output, instead of the text)");
  command->add_option("--plot", options->plot, "also draw the lobes and the albedo, as SVG");
  command->add_option("--device", options->device,
                      "which OpenCL device computes: a number or a part of its name");
  command->add_flag("--probe-only", options->probe_only, "for Oclgrind, which this command runs")->group("");
  command->callback([&context, options] {
    if (options->probe_only) return probeFew(modelNamed(options->model));
    const ModelCheck check = checkModel(modelNamed(options->model), options->device,
                                        std::filesystem::read_symlink("/proc/self/exe"));
    if (!options->plot.empty()) writeTextFile(options->plot, modelPlot(check));
    if (!options->json.empty()) writeTextFile(options->json, modelCheckJson(check));
    if (options->json != "-") fmt::print("{}", modelCheckText(check));
    if (!check.broken.empty()) context.status = kDifferent;
  });
}

}  // namespace luciole
