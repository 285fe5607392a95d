#include "lighting/compile_helper.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <string_view>

#include "base/machine_memory.hpp"
#include "base/spawn.hpp"
#include "base/threads.hpp"
#include "luciole/error.hpp"

namespace luciole {
namespace {

/// Bytes of memory that must be free for a helper beside this process. One takes 200 MB.
constexpr double kHelperBytes = 1 << 30;

/// Starts the device's helper, deaf and mute. Returns whether it could be started.
bool startHelper(const OpenedDevice& device, const std::vector<std::string>& task, short flags,
                 pid_t& child) {
  if (memoryRoom().bytes < kHelperBytes) return false;
  std::vector<std::string> arguments{"luciole", "compile"};
  arguments.insert(arguments.end(), task.begin(), task.end());
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    posix_spawn_file_actions_addopen(&actions, stream, "/dev/null", O_RDWR, 0);
  posix_spawn_file_actions_addclosefrom_np(&actions, STDERR_FILENO + 1);
  const int error = spawnProgram(device.helper, arguments, actions, flags, child);
  posix_spawn_file_actions_destroy(&actions);
  return error == 0;
}

template <class Number>
Number readNumber(std::string_view text, int base = 10) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, base);
  if (error != std::errc() || end != text.data() + text.size())
    throw InputError(fmt::format("compile: {}: expected a number", text));
  return value;
}

/// What stands before ShadeSettings::user_text.
const std::string kText = "text=";

/// The arguments of a task before its programs.
constexpr std::size_t kTaskWords = 11;

}  // namespace

std::vector<std::string> argumentsOf(const OpenedDevice& device, const CompileTask& task) {
  const ShadeSettings& settings = task.settings;
  std::vector<std::string> words{"device=" + device.selector};
  for (const int number : {int(task.choice.beams), int(task.choice.others), int(task.choice.counts),
                           int(task.quickly), settings.log2_degree, settings.exp2_degree, settings.pcf_width,
                           settings.tile_size, settings.soft_samples})
    words.push_back(std::to_string(number));
  words.push_back(kText + settings.user_text);
  for (const FeatureSet& features : task.programs) words.push_back(fmt::format("{:x}", features.bits()));
  return words;
}

DeviceTask readTask(std::span<const std::string> arguments) {
  constexpr std::string_view kDevice = "device=";
  if (arguments.size() < kTaskWords || !arguments[0].starts_with(kDevice))
    throw InputError("compile: expected a task of another process of this program");
  std::array<int, kTaskWords - 2> numbers{};
  for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = readNumber<int>(arguments[i + 1]);
  DeviceTask read{arguments[0].substr(kDevice.size()),
                  {{},
                   {},
                   {.beams = numbers[0] != 0, .others = numbers[1] != 0, .counts = numbers[2] != 0},
                   numbers[3] != 0}};
  ShadeSettings& settings = read.task.settings;
  settings.log2_degree = numbers[4];
  settings.exp2_degree = numbers[5];
  settings.pcf_width = numbers[6];
  settings.tile_size = numbers[7];
  settings.soft_samples = numbers[8];
  if (!arguments[kTaskWords - 1].starts_with(kText)) throw InputError("compile: expected a text");
  settings.user_text = arguments[kTaskWords - 1].substr(kText.size());
  for (const std::string& program : arguments.subspan(kTaskWords)) {
    const auto bits = readNumber<std::uint64_t>(program, 16);
    FeatureSet& features = read.task.programs.emplace_back();
    for (std::size_t i = 0; i < kFeatureCount; ++i) features.set(Feature(i), (bits >> i & 1) != 0);
  }
  return read;
}

void HelperProcess::start(const OpenedDevice& device, const CompileTask& task) {
  pid_t child = 0;
  if (device.helper.empty() || threadCount() < 2) return;
  if (!startHelper(device, argumentsOf(device, task), 0, child)) return;
  child_ = child;
  killing_.emplace([child] { kill(child, SIGKILL); });
}

bool HelperProcess::await() {
  if (!child_) return true;
  int status = 0;
  while (waitpid(*child_, &status, 0) < 0 && errno == EINTR) continue;
  killing_.reset();
  child_.reset();
  return status == 0;
}

void compileLeftOver(const OpenedDevice& device, const std::vector<std::string>& task) {
  pid_t child = 0;
  if (!startHelper(device, task, 0, child)) return;
  const Cleanup killing([child] { kill(child, SIGKILL); });
  while (waitpid(child, nullptr, 0) < 0 && errno == EINTR) continue;
}

void startLeftOver(const OpenedDevice& device) {
  pid_t child = 0;
  if (!device.left_over.empty()) startHelper(device, device.left_over, POSIX_SPAWN_SETSID, child);
}

}  // namespace luciole
