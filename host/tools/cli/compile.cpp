#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "cl/launch.hpp"
#include "lighting/compile_helper.hpp"
#include "tools/cli/commands.hpp"
#include "tools/devices/check_device.hpp"

namespace luciole {
namespace {

/// Returns whether no other process compiles what pictures left over, and keeps others from it until this one
/// ends.
bool takesTurn(const OpenedDevice& device) {
  const std::filesystem::path place = std::filesystem::path(device.pocl_cache) / "luciole-compiles";
  const int file = open(place.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666);
  return file >= 0 && flock(file, LOCK_EX | LOCK_NB) == 0;
}

/// Whether no picture waits for these programs.
bool isLeftOver(const CompileTask& task) { return task.choice.counts; }

void compile(const DeviceTask& what, CommandContext& context) {
  openDevice(what.selector, context.device);
  const CompileTask& task = what.task;
  if (isLeftOver(task) && !takesTurn(context.device)) return;
  context.device.compiles_quickly = task.quickly;
  for (const FeatureSet& features : task.programs)
    compileKernels(context.device, features, task.settings, task.choice);
  if (!isLeftOver(task)) return;
  knownArithmetic(context.device);
  listCompiled(context.device);
}

}  // namespace

/// A helper of other processes of this program (lighting/compile_helper.hpp), which help doesn't list.
/// Without a task it compiles the general program, as those who set this program up do.
void addCompileCommand(CLI::App& app, CommandContext& context) {
  CLI::App* command = app.add_subcommand("compile", "compile kernels for another process")->group("");
  auto words = std::make_shared<std::vector<std::string>>();
  command->add_option("TASK", *words, "what to compile");
  command->callback([&context, words] {
    if (words->empty()) return compile({"", {{generalFeatures()}, {}, {.counts = true}}}, context);
    const DeviceTask what = readTask(*words);
    [[maybe_unused]] const int priority = nice(isLeftOver(what.task) ? 19 : 0);
    compile(what, context);
  });
}

}  // namespace luciole
