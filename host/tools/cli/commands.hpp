#pragma once

#include <CLI/CLI.hpp>
#include <list>
#include <optional>
#include <string>
#include <vector>

#include "cl/device.hpp"
#include "luciole/warning.hpp"

namespace luciole {

/// The exit status of the process: 0 done, 1 the comparison failed, 2 wrong input or arguments, 3 the machine
/// failed (MachineError).
enum ExitStatus { kDone = 0, kDifferent = 1, kWrongInput = 2, kMachineFailed = 3 };

/// The state that the program and a command share.
struct CommandContext {
  std::string command_line;          ///< as typed, for metadata and statistics
  int status = kDone;                ///< the exit status, set by the command
  OpenedDevice device{};             ///< for the command to open; the end of the process closes it
  std::list<OpenedDevice> others{};  ///< that --device all opens beside it
};

/// Call it in a catch block. Writes the exception's message to standard error, as a line or an event (see
/// event_log.hpp), and returns its exit status. frame: the one that failed, of several.
int reportFailure(std::optional<int> frame = std::nullopt);

/// Writes an error to standard error, as a line or an event. status: the exit status that it leads to.
void reportError(const std::string& message, int status);

/// Writes a warning to standard error, as a line or an event.
void reportWarning(const std::string& text);
/// Lines for people: the first ten warnings of each kind, then the number of others, with the option that
/// lists them.
std::vector<std::string> shownWarnings(const std::vector<Warning>& warnings, const std::string& option);
/// Writes a scene's warnings to standard error: the lines above, or all of them as events.
void reportWarnings(const std::vector<Warning>& warnings);

// Each adds a command to the program. The command's work runs while the command line is parsed, if it is
// named there, and throws InputError and MachineError.
void addRenderCommand(CLI::App& app, CommandContext& context);
void addGBufferCommand(CLI::App& app, CommandContext& context);
void addShadeCommand(CLI::App& app, CommandContext& context);
void addRelightCommand(CLI::App& app, CommandContext& context);
void addBakeCommand(CLI::App& app, CommandContext& context);
void addMixCommand(CLI::App& app, CommandContext& context);
void addShowCommand(CLI::App& app, CommandContext& context);
void addIlluminanceCommand(CLI::App& app, CommandContext& context);
void addShadowMapCommand(CLI::App& app, CommandContext& context);
void addReferenceCommand(CLI::App& app, CommandContext& context);
void addCompareCommand(CLI::App& app, CommandContext& context);
void addBenchCommand(CLI::App& app, CommandContext& context);
void addScaleCommand(CLI::App& app, CommandContext& context);
void addGenerateCommand(CLI::App& app, CommandContext& context);
void addGltfLightsCommand(CLI::App& generate, CommandContext& context);
void addInfoCommand(CLI::App& app, CommandContext& context);
void addCompileCommand(CLI::App& app, CommandContext& context);
void addCheckModelCommand(CLI::App& app, CommandContext& context);
void addViewCommand(CLI::App& app, CommandContext& context);
void addDevicesCommand(CLI::App& app, CommandContext& context);

// These print what `app`, the program, and all commands in it are when they run. It must outlive its parsing.
void addManCommand(CLI::App& app);
void addCompletionCommand(CLI::App& app);

/// Names the values of all options that take a text, in help, manual page and completions: FILE, WxH ...
void nameValues(CLI::App& app);

}  // namespace luciole
