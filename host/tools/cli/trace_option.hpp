#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace luciole {

/// Adds the option --trace to a command. It starts a trace before the command runs. path: what was typed.
void addTraceOption(CLI::App& command, std::string& path);

/// Ends the trace and writes it to the file that --trace names, if any. command_line: as typed. Throws
/// InputError and MachineError.
void writeTrace(const std::string& command_line);

}  // namespace luciole
