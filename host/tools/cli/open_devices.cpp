#include "tools/cli/open_devices.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <future>
#include <list>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "luciole/error.hpp"
#include "tools/cli/event_log.hpp"
#include "tools/devices/check_device.hpp"

namespace luciole {
namespace {

/// What is said of a device whose bits are others than those of all others; empty: they are the same.
std::string differenceOf(const DeviceDescription& device, const std::vector<std::string>& wrong) {
  if (wrong.empty()) return "";
  return fmt::format("{}: its pictures may have other bits than those of other devices: {}", device.name,
                     wrong.front());
}

/// This program's file, which compiles kernels in processes of its own; empty with LUCIOLE_HELPERS=0.
std::string helperProgram() {
  const char* const setting = std::getenv("LUCIOLE_HELPERS");
  if (setting && std::string_view(setting) == "0") return "";
  std::error_code unknown;
  return std::filesystem::read_symlink("/proc/self/exe", unknown);
}

/// Checks a device that is open, notes the hash of its arithmetic, and says how it differs from others.
std::string checkDevice(OpenedDevice& device) {
  try {
    const ArithmeticCheck check = knownArithmetic(device);
    device.description.arithmetic = check.sha256;
    return differenceOf(device.description, check.wrong);
  } catch (const MachineError& error) {
    return differenceOf(device.description, {error.what()});
  }
}

constexpr const char* kCheckHint = " (luciole devices --check tells all)";

/// A device that --device all may mean.
struct Candidate {
  OpenedDevice* device;
  std::string difference = {};  ///< see checkDevice
  std::string failure = {};     ///< why it can't be opened
};

/// Opens and checks all devices side by side.
std::list<Candidate> openCandidates(const std::string& suffix, CommandContext& context) {
  std::list<Candidate> candidates;
  std::vector<std::future<void>> opening;
  const std::size_t count = listDevices().size();
  for (std::size_t i = 0; i < count; ++i) {
    Candidate& candidate =
        candidates.emplace_back(Candidate{i == 0 ? &context.device : &context.others.emplace_back()});
    opening.push_back(std::async(std::launch::async, [&candidate, selector = std::to_string(i) + suffix] {
      try {
        openDevice(selector, *candidate.device);
        candidate.difference = checkDevice(*candidate.device);
      } catch (const MachineError& error) {
        candidate.failure = error.what();
      }
    }));
  }
  for (std::future<void>& one : opening) one.get();
  return candidates;
}

std::vector<OpenedDevice*> openAllDevices(const PictureOptions& options, CommandContext& context) {
  const std::list<Candidate> candidates =
      openCandidates(options.device.substr(std::string_view(kAllDevices).size()), context);
  if (candidates.empty()) selectDevice({}, "");  // which says what is missing
  const bool any_exact = std::any_of(candidates.begin(), candidates.end(), [](const Candidate& one) {
    return one.failure.empty() && one.difference.empty();
  });
  std::vector<OpenedDevice*> devices;
  std::vector<std::string> told;
  for (const Candidate& candidate : candidates) {
    const std::string& what = candidate.failure.empty() ? candidate.difference : candidate.failure;
    if (!candidate.failure.empty() || (!what.empty() && (any_exact || !devices.empty()))) {
      told.push_back("left out: " + what);
      continue;
    }
    if (!what.empty() && options.require_exact) throw MachineError("--require-exact: " + what);
    if (!what.empty()) told.push_back(what + kCheckHint);
    devices.push_back(candidate.device);
  }
  if (devices.empty()) throw MachineError(candidates.front().failure);
  if (!options.quiet)
    for (const std::string& warning : told) reportWarning(warning);
  return devices;
}

}  // namespace

void startCheckedDevice(const PictureOptions& options, CommandContext& context, bool makes_one_picture) {
  OpenedDevice& device = context.device;
  device.helper = helperProgram();
  device.owns_stderr = true;
  device.makes_one_picture = makes_one_picture && !options.require_exact;
  if (!options.quiet) device.warn = reportWarning;
  if (options.require_exact)
    return startDevice(options.device, device, [&device] {
      const std::string difference = checkDevice(device);
      if (!difference.empty()) throw MachineError("--require-exact: " + difference);
    });
  device.self_check = [&device, quiet = options.quiet] {
    const std::string difference = checkDevice(device);
    if (!difference.empty() && !quiet) reportWarning(difference + kCheckHint);
  };
  startDevice(options.device, device);
}

std::vector<OpenedDevice*> startDevices(const PictureOptions& options, CommandContext& context,
                                        bool makes_one_picture) {
  if (options.device.substr(0, options.device.find(',')) == kAllDevices)
    return openAllDevices(options, context);
  startCheckedDevice(options, context, makes_one_picture);
  return {&context.device};
}

void logDevice(const DeviceDescription& device) {
  EventFields fields{{"name", device.name},
                     {"platform", device.platform},
                     {"driver", device.version},
                     {"lanes", device.lanes}};
  if (!device.arithmetic.empty()) fields["arithmetic"] = device.arithmetic;
  logEvent("device", fields);
}

}  // namespace luciole
