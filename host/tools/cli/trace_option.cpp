#include "tools/cli/trace_option.hpp"

#include "base/trace.hpp"
#include "base/write_file.hpp"
#include "tools/cli/trace_json.hpp"

namespace luciole {
namespace {

std::string trace_file;  ///< empty without --trace

}  // namespace

void addTraceOption(CLI::App& command, std::string& path) {
  command
      .add_option(
          "--trace", path,
          "write what was done when, in each thread and on the device, as JSON for ui.perfetto.dev or "
          "chrome://tracing (- : standard output)")
      ->each([](const std::string& file) {
        checkPlace(file);
        trace_file = file;
        startTrace();
      });
}

void writeTrace(const std::string& command_line) {
  if (!trace_file.empty()) writeTextFile(trace_file, traceJson(endTrace(), command_line));
}

}  // namespace luciole
