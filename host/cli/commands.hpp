#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace luciole {

/// The status of the process: 0 done, 1 the comparison failed, 2 wrong input or arguments, 3 the machine
/// can't.
enum ExitStatus { kDone = 0, kDifferent = 1, kWrongInput = 2, kMachineFailed = 3 };

/// What every command is told: the line as typed, for metadata and statistics, and where to leave its exit
/// status.
struct CommandContext {
  std::string command_line;
  int status = kDone;
};

/// To be called where an exception was caught: says on standard error, after `where` unless it is empty, what
/// is wrong, and returns the status that the exception means.
int tellFailure(const std::string& where);

/// Says on standard error, a line each, what was found while something went on.
void tellWarnings(const std::vector<std::string>& warnings);

// Each adds one command to the program; its work runs when the command line names it. They throw InputError
// and MachineError.
void addRenderCommand(CLI::App& app, CommandContext& context);
void addGBufferCommand(CLI::App& app, CommandContext& context);
void addShadeCommand(CLI::App& app, CommandContext& context);
void addReferenceCommand(CLI::App& app, CommandContext& context);
void addCompareCommand(CLI::App& app, CommandContext& context);
void addBenchCommand(CLI::App& app, CommandContext& context);
void addScaleCommand(CLI::App& app, CommandContext& context);
void addGenerateCommand(CLI::App& app, CommandContext& context);
void addDevicesCommand(CLI::App& app, CommandContext& context);

}  // namespace luciole
