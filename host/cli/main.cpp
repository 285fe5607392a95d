#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <map>
#include <new>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include "base/clock.hpp"
#include "base/error.hpp"
#include "base/machine_memory.hpp"
#include "cli/commands.hpp"
#include "cli/event_log.hpp"
#include "cli/signals.hpp"
#include "cli/suggest.hpp"
#include "cli/trace_option.hpp"

namespace {

using namespace luciole;

std::string joinedArguments(int count, char** arguments) {
  std::string line = "luciole";
  for (int i = 1; i < count; ++i) line += std::string(" ") + arguments[i];
  return line;
}

const CLI::App& findCommand(CLI::App& app, const std::string& name) {
  const std::vector<CLI::App*> all = app.get_subcommands([](const CLI::App*) { return true; });
  const auto named =
      std::find_if(all.begin(), all.end(), [&](const CLI::App* one) { return one->get_name() == name; });
  if (named != all.end()) return **named;
  std::vector<std::string> names{"test"};  // the launcher's
  for (const CLI::App* command : all) names.push_back(command->get_name());
  const std::string suggestion = didYouMean(name, names);
  throw InputError(
      fmt::format("no command {}{}", name, suggestion.empty() ? " (see luciole help)" : suggestion));
}

}  // namespace

void luciole::tellError(const std::string& message, int status) {
  if (logsEvents())
    logEvent("error", {{"message", message}, {"status", status}});
  else
    fmt::print(stderr, "luciole: {}\n", message);
}

int luciole::tellFailure(std::optional<int> frame) {
  const auto fail = [&](const std::string& message, int status) {
    if (!frame)
      tellError(message, status);
    else if (logsEvents())
      logEvent("frame_failed", {{"frame", *frame}, {"message", message}, {"status", status}});
    else
      tellError(fmt::format("frame {}: {}", *frame, message), status);
    return status;
  };
  try {
    throw;
  } catch (const CLI::ParseError& error) {
    return fail(fmt::format("{} (see luciole help)", error.what()), kWrongInput);
  } catch (const InputError& error) {
    return fail(error.what(), kWrongInput);
  } catch (const MachineError& error) {
    return fail(error.what(), kMachineFailed);
  } catch (const std::bad_alloc&) {
    return fail("out of memory", kMachineFailed);
  } catch (const std::system_error& error) {  // no more threads, for example
    return fail(fmt::format("the system refuses: {}", error.what()), kMachineFailed);
  } catch (const std::exception& error) {
    return fail(fmt::format("internal error: {}", error.what()), kMachineFailed);
  }
}

void luciole::tellWarning(const std::string& text) {
  if (logsEvents())
    logEvent("warning", {{"message", text}});
  else
    fmt::print(stderr, "luciole: warning: {}\n", text);
}

std::vector<std::string> luciole::shownWarnings(const std::vector<Warning>& warnings) {
  constexpr std::size_t kMostOfAKind = 10;
  std::vector<std::string> lines;
  std::map<std::string, std::size_t> counts;
  for (const Warning& warning : warnings)
    if (++counts[warning.kind] <= kMostOfAKind) lines.push_back(warning.text);
  for (const auto& [kind, count] : counts)
    if (count > kMostOfAKind)
      lines.push_back(fmt::format("{}: {} more, which --stats lists", kind, count - kMostOfAKind));
  return lines;
}

void luciole::tellWarnings(const std::vector<Warning>& warnings) {
  if (logsEvents())
    for (const Warning& warning : warnings) tellWarning(warning.text);
  else
    for (const std::string& line : shownWarnings(warnings)) tellWarning(line);
}

namespace {

/// Ends the process after an exception that nobody could catch. Memory may run out in a library's thread, or
/// in a noexcept function: then with a message, and with the status of a MachineError.
[[noreturn]] void endUncaught() {
  try {
    if (std::current_exception()) throw;
  } catch (const std::bad_alloc&) {
    if (logsEvents())
      logOutOfMemory(kMachineFailed);
    else
      std::fputs("luciole: out of memory\n", stderr);
    std::_Exit(kMachineFailed);
  } catch (...) {
  }
  std::abort();
}

/// Does what the command line says. Returns the exit status.
int runCommand(int argument_count, char** arguments, CommandContext& context) {
  CLI::App app{"Luciole lights scenes with as many lights as there are fireflies, deferred, on OpenCL."};
  app.set_version_flag("--version", "luciole " LUCIOLE_VERSION);
  app.require_subcommand(1);
  app.get_formatter()->column_width(34);
  app.footer(
      "luciole test sets up, builds and runs every test (through the launcher beside the README).\n"
      "Exit status: 0 done, 1 the comparison failed, 2 wrong input or arguments, 3 the machine can't.");
  addRenderCommand(app, context);
  addGBufferCommand(app, context);
  addShadeCommand(app, context);
  addRelightCommand(app, context);
  addBakeCommand(app, context);
  addMixCommand(app, context);
  addReferenceCommand(app, context);
  addCompareCommand(app, context);
  addBenchCommand(app, context);
  addScaleCommand(app, context);
  addGenerateCommand(app, context);
  addInfoCommand(app, context);
  addDevicesCommand(app, context);
  addManCommand(app);
  addCompletionCommand(app);
  std::string topic;
  CLI::App* help = app.add_subcommand("help", "what a command does and its options");
  help->add_option("COMMAND", topic, "the command to explain");
  nameValues(app);
  help->callback([&] {
    if (topic.empty()) {
      // Not app.help(): that would print the help of the command that runs, which is this one.
      fmt::print("{}", app.get_formatter()->make_help(&app, "luciole", CLI::AppFormatMode::Normal));
      return;
    }
    fmt::print("{}", findCommand(app, topic).help());
  });

  try {
    if (argument_count > 1 && arguments[1][0] != '-') findCommand(app, arguments[1]);
    app.parse(argument_count, arguments);
    writeTrace(context.command_line);
    return context.status;
  } catch (const CLI::Success& success) {
    return app.exit(success);  // --help and --version
  } catch (const CLI::ParseError&) {
    const std::string unexpected = describeUnexpected(app);
    if (unexpected.empty()) return tellFailure();
    if (logsEvents())
      logEvent("error", {{"message", "luciole" + unexpected}, {"status", kWrongInput}});
    else
      fmt::print(stderr, "luciole{}\n", unexpected);
    return kWrongInput;
  } catch (const std::exception&) {
    return tellFailure();
  }
}

// Leaks are looked for when main() has returned.
#if defined(__SANITIZE_ADDRESS__)
constexpr bool kLooksForLeaks = true;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
constexpr bool kLooksForLeaks = true;
#else
constexpr bool kLooksForLeaks = false;
#endif
#else
constexpr bool kLooksForLeaks = false;
#endif

}  // namespace

int main(int argument_count, char** arguments) {
  std::set_terminate(endUncaught);
  saveAddresses();
  CommandContext context{joinedArguments(argument_count, arguments)};
  if (asksForEvents(argument_count, arguments)) startEventLog();
  awaitSignals();
  logEvent("start", {{"command", context.command_line}, {"version", LUCIOLE_VERSION}});
  const int status = runCommand(argument_count, arguments, context);
  ignoreSignals();
  logEnd(status);
  if (kLooksForLeaks) return status;
  // All files are closed. To take the device's compiler apart would cost 6 ms, and 100 where it has compiled.
  std::fflush(nullptr);
  std::_Exit(status);
}
