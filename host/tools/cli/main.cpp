#include <dlfcn.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <ucontext.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <map>
#include <new>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "base/cleanup.hpp"
#include "base/clock.hpp"
#include "base/machine_memory.hpp"
#include "base/output_file.hpp"
#include "base/utf8.hpp"
#include "lighting/compile_helper.hpp"
#include "luciole/error.hpp"
#include "tools/cli/commands.hpp"
#include "tools/cli/event_log.hpp"
#include "tools/cli/option_names.hpp"
#include "tools/cli/signals.hpp"
#include "tools/cli/suggest.hpp"
#include "tools/cli/trace_option.hpp"

namespace {

using namespace luciole;

std::string joinedArguments(int count, char** arguments) {
  std::string line = "luciole";
  for (int i = 1; i < count; ++i) line += " " + utf8Of(arguments[i]);
  return line;
}

const CLI::App& findCommand(CLI::App& app, const std::string& name) {
  const std::vector<CLI::App*> all = app.get_subcommands([](const CLI::App*) { return true; });
  const auto named =
      std::find_if(all.begin(), all.end(), [&](const CLI::App* one) { return one->get_name() == name; });
  if (named != all.end()) return **named;
  std::vector<std::string> names{"test"};  // the launcher's
  for (const CLI::App* command : all)
    if (!command->get_group().empty()) names.push_back(command->get_name());  // which help shows
  const std::string suggestion = didYouMean(name, names);
  throw InputError(
      fmt::format("no command {}{}", name, suggestion.empty() ? " (see luciole help)" : suggestion));
}

}  // namespace

void luciole::reportError(const std::string& message, int status) {
  if (logsEvents())
    logEvent("error", {{"message", message}, {"status", status}});
  else
    writeError(fmt::format("luciole: {}\n", message));
}

int luciole::reportFailure(std::optional<int> frame) {
  const auto fail = [&](const std::string& message, int status) {
    if (!frame)
      reportError(message, status);
    else if (logsEvents())
      logEvent("frame_failed", {{"frame", *frame}, {"message", message}, {"status", status}});
    else
      reportError(fmt::format("frame {}: {}", *frame, message), status);
    return status;
  };
  try {
    throw;
  } catch (const CLI::ParseError& error) {
    return fail(fmt::format("{} (see luciole help)", error.what()), kWrongInput);
  } catch (const InputError& error) {
    return fail(withOptionNames(error.what()), kWrongInput);
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

void luciole::reportWarning(const std::string& text) {
  if (logsEvents())
    logEvent("warning", {{"message", text}});
  else
    writeError(fmt::format("luciole: warning: {}\n", text));
}

std::vector<std::string> luciole::shownWarnings(const std::vector<Warning>& warnings,
                                                const std::string& option) {
  constexpr std::size_t kMostOfAKind = 10;
  std::vector<std::string> lines;
  std::map<std::string, std::size_t> counts;
  for (const Warning& warning : warnings)
    if (++counts[warning.kind] <= kMostOfAKind) lines.push_back(warning.text);
  for (const auto& [kind, count] : counts)
    if (count > kMostOfAKind)
      lines.push_back(fmt::format("{}: {} more, which {} lists", kind, count - kMostOfAKind, option));
  return lines;
}

void luciole::reportWarnings(const std::vector<Warning>& warnings) {
  if (logsEvents())
    for (const Warning& warning : warnings) reportWarning(warning.text);
  else
    for (const std::string& line : shownWarnings(warnings, "--stats")) reportWarning(line);
}

namespace {

/// Ends the process with a line, and without a step that may wait for a lock or take memory: other threads,
/// or a library that gave up, may hold any lock.
[[noreturn]] void endAtOnce(const char* message) noexcept {
  static std::atomic_flag is_ending;
  while (is_ending.test_and_set()) pause();  // another thread is at it
  if (logsEvents()) {
    logFailure(message, kMachineFailed);
  } else {
    std::array<char, 200> line{};
    std::snprintf(line.data(), line.size(), "luciole: %s\n", message);
    writeError(line.data());
  }
  removeHiddenFiles();
  std::_Exit(kMachineFailed);
}

/// Ends the process after an exception that nobody could catch. Memory may run out in a library's thread, in
/// a noexcept function, or before main().
[[noreturn]] void endUncaught() {
  try {
    if (std::current_exception()) throw;
  } catch (const std::bad_alloc&) {
    endAtOnce("out of memory");
  } catch (const MachineError& error) {
    endAtOnce(error.what());
  } catch (const std::system_error&) {
    endAtOnce("the system refuses what a library needs");
  } catch (...) {
  }
  endAtOnce("internal error: an exception that nobody catches");
}

void endAborted(int) { endAtOnce("a library gave up, as some do where memory runs out"); }

/// Whether an instruction is of the program or of its own libraries, as is taken of one that is in no file.
bool isOwnCode(const void* instruction) {
  Dl_info file;
  if (instruction == nullptr || dladdr(instruction, &file) == 0) return true;
  const char* const slash = std::strrchr(file.dli_fname, '/');
  const std::string_view name = slash ? slash + 1 : file.dli_fname;
  return name.starts_with("luciole") || name.starts_with("libluciole");
}

constexpr std::uintptr_t kFirstPage = 4096;

/// The instruction at which a signal came, or that called a function at an address of the first page; null
/// where it isn't known.
const void* instructionOf(const void* context) {
  [[maybe_unused]] const mcontext_t& machine = static_cast<const ucontext_t*>(context)->uc_mcontext;
#if defined(__x86_64__)
  const auto at = std::uintptr_t(machine.gregs[REG_RIP]);
  const auto* const stack = reinterpret_cast<const std::uintptr_t*>(machine.gregs[REG_RSP]);
  return reinterpret_cast<const void*>(at < kFirstPage ? *stack : at);
#elif defined(__aarch64__)
  return reinterpret_cast<const void*>(machine.pc < kFirstPage ? machine.regs[30] : machine.pc);
#else
  return nullptr;
#endif
}

/// Libraries that don't look at what malloc() gave them use the first page of addresses.
void endCrashed(int, siginfo_t* fault, void* context) {
  if (reinterpret_cast<std::uintptr_t>(fault->si_addr) < kFirstPage && !isOwnCode(instructionOf(context)))
    endAtOnce("a library crashed where it used no memory, as some do where memory runs out");
  std::signal(SIGSEGV, SIG_DFL);  // and the same again
}

// Leaks are looked for when main() has returned, and by these tools an abort is told.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kIsSanitized = true;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
constexpr bool kIsSanitized = true;
#else
constexpr bool kIsSanitized = false;
#endif
#else
constexpr bool kIsSanitized = false;
#endif

/// What the dynamic loader calls before any library that the program links is started.
void catchEverything() {
  std::set_terminate(endUncaught);
  if (kIsSanitized) return;
  std::signal(SIGABRT, endAborted);
  std::signal(SIGTRAP, endAborted);  // GLib's way
  struct sigaction crash {};
  crash.sa_sigaction = endCrashed;
  crash.sa_flags = SA_SIGINFO;
  sigaction(SIGSEGV, &crash, nullptr);
}
__attribute__((section(".preinit_array"), used)) void (*before_libraries)() = catchEverything;

/// Opens standard input, output and error where the caller closed them: else the next file that is opened
/// would get what is printed. To write to standard output is an error then, to standard error none.
void openStandardStreams() {
  for (const auto& [stream, how] : {std::pair{0, O_WRONLY}, {1, O_RDONLY}, {2, O_RDWR}})
    if (fcntl(stream, F_GETFD) < 0 && errno == EBADF) open("/dev/null", how);
}

/// Writes what was printed. Returns the status, that of a failure where something is lost and no failure was
/// told before.
int flushOutput(int status) {
  errno = 0;
  if (std::fflush(stdout) == 0 && !std::ferror(stdout)) return status;
  if (status == kWrongInput || status == kMachineFailed) return status;
  reportError(fmt::format("standard output: can't write{}", errno ? ": " + systemReason() : ""),
              kMachineFailed);
  return kMachineFailed;
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
  addShowCommand(app, context);
  addIlluminanceCommand(app, context);
  addShadowMapCommand(app, context);
  addReferenceCommand(app, context);
  addCompareCommand(app, context);
  addBenchCommand(app, context);
  addScaleCommand(app, context);
  addGenerateCommand(app, context);
  addInfoCommand(app, context);
  addCheckModelCommand(app, context);
  addViewCommand(app, context);
  addDevicesCommand(app, context);
  addCompileCommand(app, context);
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
    if (unexpected.empty()) return reportFailure();
    if (logsEvents())
      logEvent("error", {{"message", "luciole" + unexpected}, {"status", kWrongInput}});
    else
      writeError(fmt::format("luciole{}\n", unexpected));
    return kWrongInput;
  } catch (const std::exception&) {
    return reportFailure();
  }
}

}  // namespace

/// Takes the place of the C library's, which libraries call that give up: LLVM puts a handler of its own in
/// the place of endAborted(), in the middle of a call that looks for devices.
extern "C" void abort() noexcept {
  if (!kIsSanitized) endAborted(SIGABRT);
  std::signal(SIGABRT, SIG_DFL);
  std::raise(SIGABRT);
  std::_Exit(kMachineFailed);
}

int main(int argument_count, char** arguments) {
  openStandardStreams();
  limitMallocArenas();
  CommandContext context{joinedArguments(argument_count, arguments)};
  if (asksForEvents(argument_count, arguments)) startEventLog();
  awaitSignals();
  logEvent("start", {{"command", context.command_line}, {"version", LUCIOLE_VERSION}});
  const int status = flushOutput(runCommand(argument_count, arguments, context));
  ignoreSignals();
  startLeftOver(context.device);
  logEnd(status);
  if (kIsSanitized) return status;
  // All files are closed. To take the device's compiler apart would cost 6 ms, and 100 where it has compiled.
  std::_Exit(status);
}
